// SPDX-License-Identifier: MIT
#include "sink/gltf/gltf_bins.hpp"

#include <string_view>
#include <utility>

#include "sink/file_writer.hpp"
#include "sink/gltf/gltf_parts.hpp"

namespace mc::sink {

namespace {

std::string percent_encoded(std::string_view name) {
  constexpr std::string_view kPlain =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-._~";
  constexpr std::string_view kHex = "0123456789ABCDEF";
  std::string uri;
  for (const char c : name) {
    if (kPlain.find(c) != std::string_view::npos) {
      uri += c;
    } else {
      const auto byte = static_cast<unsigned char>(c);
      uri.append({'%', kHex[byte >> 4], kHex[byte & 15]});
    }
  }
  return uri;
}

std::string bin_path(const std::string& gltf_path, std::size_t n_before) {
  constexpr std::string_view kExtension = ".gltf";
  const std::string number = n_before == 0 ? "" : "-" + std::to_string(n_before + 1);
  return (gltf_path.ends_with(kExtension)
              ? gltf_path.substr(0, gltf_path.size() - kExtension.size())
              : gltf_path) +
         number + ".bin";
}

}  // namespace

BinFiles::BinFiles(std::string gltf_path, SinkOptions options, std::uint64_t most_bytes)
    : gltf_path_(std::move(gltf_path)), options_(std::move(options)), most_bytes_(most_bytes) {
  add();
}

OutputFile& BinFiles::add() {
  files_.push_back(std::make_unique<OutputFile>(bin_path(gltf_path_, files_.size()),
                                                output_options(options_, true)));
  return *files_.back();
}

FileWriter& BinFiles::writer() { return files_.back()->writer(); }

std::vector<GltfObject> BinFiles::spread(const GltfObject& whole) {
  std::unique_ptr<OutputFile> from;
  if (whole.vertices_at == 0) {  // its first part takes its place, by another partial file
    from = std::move(files_.back());
    files_.pop_back();
  }
  OutputFile& source = from ? *from : *files_.back();
  source.writer().flush();
  const auto open = [&]() -> FileWriter& {
    if (!files_.empty() && files_.back().get() != &source) {
      files_.back()->close();  // there may be more of them than a process may have open
    }
    return add().writer();
  };
  std::vector<GltfObject> parts;
  cut_into_parts(source.writer(), whole, most_bytes_, open, [&](const GltfObject& part) {
    parts.push_back(part);
    parts.back().buffer = last();
    n_repeated_ += part.n_vertices;
  });
  n_repeated_ -= whole.n_vertices;
  if (!from) {
    source.writer().truncate(whole.vertices_at);
  }
  return parts;
}

std::vector<GltfBuffer> BinFiles::buffers() const {
  std::vector<GltfBuffer> out;
  for (const auto& file : files_) {
    const std::string& path = file->place();
    out.push_back({file->size(), percent_encoded(path.substr(path.rfind('/') + 1))});
  }
  return out;
}

std::vector<OutputFile*> BinFiles::files() {
  std::vector<OutputFile*> out;
  if (files_.front()->size() == 0) return out;
  for (const auto& file : files_) out.push_back(file.get());
  return out;
}

void BinFiles::note_parts() const {
  if (files_.size() > 1 && options_.progress != nullptr) {
    options_.progress->warn(gltf_path_ + ": " + std::to_string(files_.size()) +
                            " .bin files, since one holds less than 4 GiB; vertices on their "
                            "seams are there more than once: " +
                            std::to_string(n_repeated_) + " more than the mesh has");
  }
}

}  // namespace mc::sink
