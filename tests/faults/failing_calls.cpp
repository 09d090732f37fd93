// SPDX-License-Identifier: MIT
// Loaded before the C library (LD_PRELOAD): real system calls that fail when a test wants them to.
// Calls on files below a folder, and on pipes, are numbered; the environment says which of them
// fail and how:
//
//   MC_FAULT_FOLDER=PATH    files that count, and relative names; pipes always do
//   MC_FAULT_CALLS=A,B,...  calls that are numbered (default: all that are known here)
//   MC_FAULT_AT=N           number N fails, once
//   MC_FAULT_ERRNO=E        ... with this error
//   MC_FAULT_STOP=N         before number N the process stops by SIGSTOP
//   MC_FAULT_SLOW=N         number N takes ten seconds, whatever signals come
//   MC_FAULT_WITHOUT=A,...  calls that always fail as on file systems that do not have them
//   MC_FAULT_SHORT=1        reads, writes and copies move between one byte and half of what they
//   may MC_FAULT_EINTR=N        every N-th call is interrupted before it has done anything
//   MC_FAULT_ALARM=USEC     SIGALRM so often, with a handler that restarts no call
//   MC_FAULT_LOG=PATH       a line a call: "N CALL FILE [OTHER FILE] [fails|interrupted]"
//
// Calls that the C library makes by itself (stdio, the loader) do not pass here.

#include <dlfcn.h>
#include <fcntl.h>
#include <sys/mman.h>
#include <sys/sendfile.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace {

using Path = std::array<char, PATH_MAX>;

long number_from(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? 0 : std::strtol(text, nullptr, 10);
}

std::string_view text_from(const char* name) {
  const char* text = std::getenv(name);
  return text == nullptr ? std::string_view() : text;
}

struct Plan {
  std::string_view folder = text_from("MC_FAULT_FOLDER");
  std::string_view calls = text_from("MC_FAULT_CALLS");
  std::string_view without = text_from("MC_FAULT_WITHOUT");
  long at = number_from("MC_FAULT_AT");
  long stop = number_from("MC_FAULT_STOP");
  long slow = number_from("MC_FAULT_SLOW");
  int error = static_cast<int>(number_from("MC_FAULT_ERRNO"));
  bool is_short = number_from("MC_FAULT_SHORT") != 0;
  long interrupt_every = number_from("MC_FAULT_EINTR");
  int log = -1;

  Plan() {
    const char* path = std::getenv("MC_FAULT_LOG");
    if (path != nullptr) {
      const auto fd = static_cast<int>(
          ::syscall(SYS_openat, AT_FDCWD, path, O_WRONLY | O_CREAT | O_APPEND, 0600));
      constexpr int kOutOfTheWay = 900;
      log = ::fcntl(fd, F_DUPFD_CLOEXEC, kOutOfTheWay);
      ::syscall(SYS_close, fd);
    }
  }
};

bool lists(std::string_view names, std::string_view name) {
  while (!names.empty()) {
    const std::size_t comma = std::min(names.find(','), names.size());
    if (names.substr(0, comma) == name) return true;
    names.remove_prefix(std::min(comma + 1, names.size()));
  }
  return false;
}

Plan& plan() {
  static Plan the_plan;
  return the_plan;
}

std::atomic<long> n_calls{0};

/// What the descriptor is open on, as the kernel says it.
void name_of(int fd, Path& path) {
  Path link;
  std::snprintf(link.data(), link.size(), "/proc/self/fd/%d", fd);
  const ssize_t n = ::readlink(link.data(), path.data(), path.size() - 1);
  path[static_cast<std::size_t>(std::max<ssize_t>(n, 0))] = '\0';
}

/// Pipes, what lies in the folder, and names from there on: tests run below it.
bool counts(const char* path) {
  const std::string_view text(path);
  return text.starts_with("pipe:") || text.starts_with(plan().folder) ||
         (!text.empty() && text.front() != '/');
}

void log_call(long n, const char* call, const char* file, const char* other, const char* end) {
  if (plan().log < 0) return;
  std::array<char, 3 * PATH_MAX> line;
  const int length =
      std::snprintf(line.data(), line.size(), "%ld\t%s\t%s\t%s\t%s\n", n, call, file, other, end);
  ::syscall(SYS_write, plan().log, line.data(), static_cast<std::size_t>(length));
}

/// Whether this call fails: errno is set then.
bool fails(const char* call, const char* file, const char* other = "") {
  const int before = errno;
  if (!counts(file) && !counts(other)) return false;
  if (lists(plan().without, call)) {
    errno = EOPNOTSUPP;
    return true;
  }
  if (!plan().calls.empty() && !lists(plan().calls, call)) return false;
  const long n = ++n_calls;
  if (n == plan().stop) ::kill(::getpid(), SIGSTOP);
  if (n == plan().slow) {
    log_call(n, call, file, other, "slow");
    for (unsigned left = 10; left > 0;) left = ::sleep(left);
  }
  if (n == plan().at) {
    log_call(n, call, file, other, "fails");
    errno = plan().error;
    return true;
  }
  constexpr std::string_view kInterruptible =
      "open,read,pread,write,pwrite,copy_file_range,sendfile,fsync,ftruncate,close";
  if (plan().interrupt_every > 0 && n % plan().interrupt_every == 0 &&
      lists(kInterruptible, call)) {
    log_call(n, call, file, other, "interrupted");
    errno = EINTR;
    return true;
  }
  log_call(n, call, file, other, "");
  errno = before;
  return false;
}

bool fails(const char* call, int fd, int other_fd = -1) {
  if (fd == STDERR_FILENO) return false;
  const int before = errno;
  Path file, other{};
  name_of(fd, file);
  if (other_fd >= 0) name_of(other_fd, other);
  errno = before;
  return fails(call, file.data(), other.data());
}

std::size_t shortened(std::size_t n) {
  if (!plan().is_short || n < 2) return n;
  const auto turn = static_cast<std::size_t>(n_calls.load());
  return 1 + turn * 7919 % std::max<std::size_t>(n / 2, 1);
}

/// The C library's own function of that name.
template <class Function>
Function* real(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void nothing(int /*signal*/) {}

[[gnu::constructor]] void start() {
  plan();
  const long every = number_from("MC_FAULT_ALARM");
  if (every == 0) return;
  struct sigaction action {};
  action.sa_handler = nothing;  // no SA_RESTART
  ::sigaction(SIGALRM, &action, nullptr);
  const itimerval timer{{0, every}, {0, every}};
  ::setitimer(ITIMER_REAL, &timer, nullptr);
}

}  // namespace

#define REAL(name) static auto* const the_real = real<decltype(name)>(#name)

extern "C" {

ssize_t write(int fd, const void* bytes, size_t n) {
  REAL(write);
  return fails("write", fd) ? -1 : the_real(fd, bytes, shortened(n));
}

ssize_t pwrite(int fd, const void* bytes, size_t n, off_t at) {
  REAL(pwrite);
  return fails("pwrite", fd) ? -1 : the_real(fd, bytes, shortened(n), at);
}

ssize_t read(int fd, void* bytes, size_t n) {
  REAL(read);
  return fails("read", fd) ? -1 : the_real(fd, bytes, shortened(n));
}

ssize_t pread(int fd, void* bytes, size_t n, off_t at) {
  REAL(pread);
  return fails("pread", fd) ? -1 : the_real(fd, bytes, shortened(n), at);
}

ssize_t copy_file_range(int in, off64_t* in_at, int out, off64_t* out_at, size_t n,
                        unsigned flags) {
  REAL(copy_file_range);
  return fails("copy_file_range", in, out) ? -1
                                           : the_real(in, in_at, out, out_at, shortened(n), flags);
}

ssize_t sendfile(int out, int in, off_t* at, size_t n) noexcept {
  REAL(sendfile);
  return fails("sendfile", in, out) ? -1 : the_real(out, in, at, shortened(n));
}

int open(const char* path, int flags, ...) {
  REAL(open);
  va_list rest;
  va_start(rest, flags);
  const mode_t mode = (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(rest, mode_t) : 0;
  va_end(rest);
  const char* const name = (flags & O_TMPFILE) == O_TMPFILE ? "tmpfile"
                           : (flags & O_CREAT) != 0         ? "create"
                                                            : "open";
  return fails(name, path) ? -1 : the_real(path, flags, mode);
}

int mkostemp(char* name, int flags) {
  REAL(mkostemp);
  return fails("create", name) ? -1 : the_real(name, flags);
}

int close(int fd) {
  REAL(close);
  const bool failing = fails("close", fd);
  const int error = errno;
  const int done = the_real(fd);  // what fails has closed it all the same
  if (!failing) return done;
  errno = error;
  return -1;
}

int rename(const char* from, const char* to) noexcept {
  REAL(rename);
  return fails("rename", from, to) ? -1 : the_real(from, to);
}

int renameat2(int from_fd, const char* from, int to_fd, const char* to, unsigned flags) noexcept {
  REAL(renameat2);
  return fails("renameat2", from, to) ? -1 : the_real(from_fd, from, to_fd, to, flags);
}

int link(const char* from, const char* to) noexcept {
  REAL(link);
  return fails("link", from, to) ? -1 : the_real(from, to);
}

int unlink(const char* path) noexcept {
  REAL(unlink);
  return fails("unlink", path) ? -1 : the_real(path);
}

int fsync(int fd) {
  REAL(fsync);
  return fails("fsync", fd) ? -1 : the_real(fd);
}

int ftruncate(int fd, off_t n) noexcept {
  REAL(ftruncate);
  return fails("ftruncate", fd) ? -1 : the_real(fd, n);
}

void* mmap(void* at, size_t n, int protection, int flags, int fd, off_t offset) noexcept {
  REAL(mmap);
  if (fd >= 0 && fails("mmap", fd)) return MAP_FAILED;
  return the_real(at, n, protection, flags, fd, offset);
}

}  // extern "C"
