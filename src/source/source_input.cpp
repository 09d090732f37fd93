// SPDX-License-Identifier: MIT
#include "source/source_input.hpp"

#include <utility>

namespace mc {

namespace source {

namespace {

class MappedBytes final : public InputBytes {
 public:
  explicit MappedBytes(MappedFile file) : file_(std::move(file)) {}
  [[nodiscard]] std::span<const std::byte> bytes() const override { return file_.bytes(); }

 private:
  MappedFile file_;
};

}  // namespace

InputFile& first_file(SourceInput& input) {
  auto& first = input.state().first;
  return first ? *first : first.emplace(input.state().files.paths.front());
}

InputFile take_file(SourceInput& input, std::size_t n) {
  auto& first = input.state().first;
  if (n != 0 || !first) return InputFile(input.state().files.paths.at(n));
  InputFile file = std::move(*first);
  first.reset();
  return file;
}

MappedFile map_file(SourceInput& input, std::size_t n, MappedFile::Keep keep) {
  return MappedFile(take_file(input, n), MappedFile::kUnlimited, input.state().progress, keep);
}

}  // namespace source

SourceInput::SourceInput(std::unique_ptr<State> state) : state_(std::move(state)) {}
SourceInput::~SourceInput() = default;

const std::string& SourceInput::place() const { return state_->files.place; }

std::span<const std::string> SourceInput::paths() const { return state_->files.paths; }

std::string_view SourceInput::head(std::size_t n) { return source::first_file(*this).head(n); }

std::unique_ptr<ByteStream> SourceInput::stream(std::size_t n) {
  source::InputFile file = source::take_file(*this, n);
  file.refuse_device();
  return std::move(file).stream();
}

std::unique_ptr<InputBytes> SourceInput::map(std::size_t n) {
  return std::make_unique<source::MappedBytes>(source::map_file(*this, n));
}

}  // namespace mc
