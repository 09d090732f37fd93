// SPDX-License-Identifier: MIT
#include "sink/output_file.hpp"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

#include "mc/host.hpp"
#include "unit/sink/sink_support.hpp"

namespace mc::sink {
namespace {

using test::error_text;
using test::read_all;
using test::TemporaryFolder;
using test::write_all;

std::span<const std::byte> bytes_of(const std::string& text) {
  return std::as_bytes(std::span<const char>(text));
}

mode_t permissions(const std::string& path) {
  struct stat status {};
  ::stat(path.c_str(), &status);
  return status.st_mode & 07777;
}

TEST(OutputFile, AppearsOnCommitOnly) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a.bin", {});
  file.append("abc");
  EXPECT_TRUE(file.seekable());
  EXPECT_EQ(file.size(), 3U);
  EXPECT_FALSE(std::filesystem::exists(folder / "a.bin"));
  EXPECT_EQ(folder.n_entries(), 1U);  // the partial file
  file.commit();
  EXPECT_EQ(read_all(folder / "a.bin"), "abc");
  EXPECT_EQ(folder.n_entries(), 1U);
}

TEST(OutputFile, LeavesNothingWithoutCommit) {
  const TemporaryFolder folder;
  { OutputFile(folder / "a.bin", {}).append("abc"); }
  EXPECT_EQ(folder.n_entries(), 0U);
}

TEST(OutputFile, PartialNamesItsOutput) {
  const TemporaryFolder folder;
  const OutputFile file(folder / "a.bin", {});
  const auto entry = *std::filesystem::directory_iterator(folder / "");
  const std::string name = entry.path().filename().string();
  EXPECT_EQ(name.substr(0, 14), "a.bin.partial-");
  EXPECT_EQ(name.size(), 18U);
}

TEST(OutputFile, TakesTheLongestName) {
  const TemporaryFolder folder;
  const std::string name(255, 'n');
  OutputFile file(folder / name, {});
  file.append("abc");
  file.commit();
  EXPECT_EQ(read_all(folder / name), "abc");
}

TEST(OutputFile, ObeysTheUmaskAndKeepsPermissionsOfWhatItReplaces) {
  const TemporaryFolder folder;
  const mode_t before = ::umask(027);
  OutputFile(folder / "new", {}).commit();
  ::umask(before);
  EXPECT_EQ(permissions(folder / "new"), 0640U);
  ::chmod((folder / "new").c_str(), 0604);
  OutputFile(folder / "new", {.force = true}).commit();
  EXPECT_EQ(permissions(folder / "new"), 0604U);
}

TEST(OutputFile, RefusesToReplaceAtOpenAndAtCommit) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.bin";
  OutputFile late(path, {});
  late.append("late");
  write_all(path, "first");
  const std::string refusal = path + ": exists; add --force to replace it";
  EXPECT_EQ(error_text([&] { OutputFile(path, {}); }, ErrorKind::output), refusal);
  EXPECT_EQ(error_text([&] { late.commit(); }, ErrorKind::output), refusal);
  EXPECT_EQ(read_all(path), "first");
}

TEST(OutputFile, ReplacesByForce) {
  const TemporaryFolder folder;
  write_all(folder / "a.bin", "first");
  OutputFile file(folder / "a.bin", {.force = true});
  file.append("second");
  EXPECT_EQ(read_all(folder / "a.bin"), "first");
  file.commit();
  EXPECT_EQ(read_all(folder / "a.bin"), "second");
}

TEST(OutputFile, FollowsLinks) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "real");
  std::filesystem::create_symlink("real/a.bin", folder / "link");
  std::filesystem::create_symlink("link", folder / "link-to-link");
  OutputFile first(folder / "link-to-link", {});  // dangling: the target is made
  first.append("abc");
  first.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_all(folder / "real/a.bin"), "abc");
  EXPECT_EQ(error_text([&] { OutputFile(folder / "link", {}); }, ErrorKind::output),
            folder / "link: exists; add --force to replace it");
  OutputFile second(folder / "link", {.force = true});
  second.append("def");
  second.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(read_all(folder / "real/a.bin"), "def");
}

TEST(OutputFile, SaysWhatTheSystemSays) {
  const TemporaryFolder folder;
  EXPECT_EQ(error_text([&] { OutputFile(folder / "no/a.bin", {}); }, ErrorKind::output),
            folder / "no/a.bin: cannot create: No such file or directory; create the folder " +
                (folder / "no") + " first");
  EXPECT_EQ(error_text([&] { OutputFile(folder / "", {}); }, ErrorKind::output),
            folder / ": is a folder, but a file was expected");
  EXPECT_EQ(error_text([] { OutputFile("", {}); }, ErrorKind::output), "names no file");
  std::filesystem::create_symlink("loop", folder / "loop");
  EXPECT_EQ(error_text([&] { OutputFile(folder / "loop", {}); }, ErrorKind::output),
            folder / "loop: cannot create: Too many levels of symbolic links");
}

TEST(OutputFile, RefusesAReadOnlyFolder) {
  if (::geteuid() == 0) {
    GTEST_SKIP() << "root may write anywhere";
  }
  const TemporaryFolder folder;
  ::chmod((folder / "").c_str(), 0500);
  EXPECT_EQ(error_text([&] { OutputFile(folder / "a", {}); }, ErrorKind::output),
            folder / "a: cannot create: Permission denied; choose a folder that can be written");
}

TEST(OutputFile, WritesDevicesInPlace) {
  OutputFile null("/dev/null", {});
  EXPECT_FALSE(null.seekable());
  null.append("abc");
  null.commit();
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
  OutputFile full("/dev/full", {});
  full.append("abc");
  EXPECT_EQ(error_text([&] { full.commit(); }, ErrorKind::output),
            "/dev/full: cannot write: No space left on device");
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));
}

TEST(OutputFile, WritesAFifoInPlace) {
  EXPECT_EQ(test::through_fifo([](const std::string& path) {
              OutputFile file(path, {});
              file.append(std::string(3'000'000, 'x'));
              file.append("end");
              file.commit();
            }),
            std::string(3'000'000, 'x') + "end");
}

TEST(OutputFile, AppendsAndOverwritesInAnyOrder) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a", {});
  file.append("abcdef");
  file.write_at(1, bytes_of("BC"));  // still in the buffer
  file.append("gh");
  file.write_at(10, bytes_of("KL"));  // past the end
  EXPECT_EQ(file.size(), 8U);
  file.append("ij");
  file.skip(2);
  file.append("m");
  EXPECT_EQ(file.size(), 13U);
  file.commit();
  EXPECT_EQ(read_all(folder / "a"), "aBCdefghijKLm");
}

TEST(OutputFile, AppendsMoreThanItsBuffer) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a", {});
  std::string expected;
  for (int i = 0; i < 5; ++i) {
    const std::string piece(static_cast<std::size_t>(700'000 * i + 3), static_cast<char>('a' + i));
    file.append(piece);
    expected += piece;
  }
  file.commit();
  EXPECT_TRUE(read_all(folder / "a") == expected);
}

TEST(OutputFile, ShiftsWhatOverlapsItself) {
  const TemporaryFolder folder;
  std::string body(2'500'000, ' ');
  for (std::size_t i = 0; i < body.size(); ++i) {
    body[i] = static_cast<char>('a' + i % 23);
  }
  OutputFile file(folder / "a", {});
  file.append("head" + body);
  file.shift(4, 3);
  file.write_at(4, bytes_of("..."));
  EXPECT_EQ(file.size(), 7 + body.size());
  file.append("tail");
  file.commit();
  EXPECT_TRUE(read_all(folder / "a") == "head..." + body + "tail");
}

TEST(OutputFile, CommitsSeveralOrNone) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.bin", {});
  OutputFile second(folder / "a.gltf", {});
  first.append("1");
  write_all(folder / "a.gltf", "in the way");
  EXPECT_EQ(error_text(
                [&] {
                  OutputFile::commit_all({&first, &second});
                },
                ErrorKind::output),
            folder / "a.gltf: exists; add --force to replace it");
  EXPECT_FALSE(std::filesystem::exists(folder / "a.bin"));
  EXPECT_EQ(read_all(folder / "a.gltf"), "in the way");
}

/// What a signal does, in a process of its own: it is the end of one.
[[noreturn]] void interrupt() {
  unlink_partials();
  std::_Exit(0);
}

TEST(OutputFile, CommitsSeveral) {
  const TemporaryFolder folder;
  OutputFile first(folder / "a.bin", {});
  OutputFile second(folder / "a.gltf", {});
  OutputFile::commit_all({&first, &second});
  EXPECT_EXIT(interrupt(), testing::ExitedWithCode(0), "");
  EXPECT_EQ(folder.n_entries(), 2U);
}

TEST(OutputFile, PutsBackWhatSeveralWereToReplace) {
  const TemporaryFolder folder;
  write_all(folder / "a.bin", "old");
  OutputFile first(folder / "a.bin", {.force = true});
  OutputFile second(folder / "a.gltf", {});
  first.append("new");
  write_all(folder / "a.gltf", "in the way");
  EXPECT_EQ(error_text(
                [&] {
                  OutputFile::commit_all({&first, &second});
                },
                ErrorKind::output),
            folder / "a.gltf: exists; add --force to replace it");
  EXPECT_EQ(read_all(folder / "a.bin"), "old");
  EXPECT_EQ(read_all(folder / "a.gltf"), "in the way");
}

TEST(OutputFile, InterruptTakesPartialsAway) {
  const TemporaryFolder folder;
  const OutputFile first(folder / "a", {});
  const OutputFile second(folder / "b", {});
  EXPECT_EQ(folder.n_entries(), 2U);
  EXPECT_EXIT(interrupt(), testing::ExitedWithCode(0), "");
  EXPECT_EQ(folder.n_entries(), 0U);
}

TEST(SpoolFile, GivesBackWhatWasAppended) {
  const TemporaryFolder folder;
  OutputFile file(folder / "a", {});
  SpoolFile spool(file);
  EXPECT_TRUE(spool.map().empty());
  const std::string large(2'000'001, 'x');
  spool.append(bytes_of("abc"));
  spool.append(bytes_of(large));
  EXPECT_EQ(spool.size(), 2'000'004U);
  EXPECT_EQ(spool.map().size(), 2'000'004U);
  EXPECT_EQ(spool.map()[2], std::byte{'c'});
  spool.append(bytes_of("d"));
  EXPECT_EQ(spool.map()[2'000'004], std::byte{'d'});
  std::array<std::byte, 2> some{};
  spool.read(1, some);
  EXPECT_EQ(some, (std::array{std::byte{'b'}, std::byte{'c'}}));
  EXPECT_EQ(folder.n_entries(), 1U);  // the spool has no name
  spool.copy_to(file);
  file.commit();
  EXPECT_TRUE(read_all(folder / "a") == "abc" + large + "d");
}

TEST(SpoolFile, OfAStreamLiesInTmpdir) {
  const TemporaryFolder folder;
  const char* before = ::getenv("TMPDIR");
  const std::string kept = before == nullptr ? "/tmp" : before;
  ::setenv("TMPDIR", (folder / "missing").c_str(), 1);
  const OutputFile null("/dev/null", {});
  EXPECT_EQ(error_text([&] { SpoolFile{null}; }, ErrorKind::output),
            folder /
                "missing (temporary file): cannot create: No such file or directory; point "
                "TMPDIR at a folder that can be written");
  ::setenv("TMPDIR", kept.c_str(), 1);
}

}  // namespace
}  // namespace mc::sink
