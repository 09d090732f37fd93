// SPDX-License-Identifier: MIT
#if MC_WITH_EXR

#include "source/image/module/exr_context.hpp"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <utility>

#include "field/volume_names.hpp"
#include "mc/base.hpp"

// Bytes for OpenEXR's core library, its messages, and the attributes that mc writes.

namespace mc::source {

namespace {

/// The library reports on the thread that called it, then returns a code.
thread_local std::string last_message;

void note_message(exr_const_context_t /*context*/, exr_result_t code, const char* text) {
  last_message = text != nullptr && *text != '\0' ? text : ::exr_get_default_error_message(code);
}

std::span<const std::byte> bytes_behind(void* user) {
  return *static_cast<const std::span<const std::byte>*>(user);
}

std::int64_t read_bytes(exr_const_context_t /*context*/, void* user, void* out, std::uint64_t n,
                        std::uint64_t offset, exr_stream_error_func_ptr_t /*error*/) {
  const auto bytes = bytes_behind(user);
  if (offset >= bytes.size()) return 0;
  const auto there = std::min<std::uint64_t>(n, bytes.size() - offset);
  std::memcpy(out, bytes.data() + offset, there);
  return static_cast<std::int64_t>(there);
}

std::int64_t count_bytes(exr_const_context_t /*context*/, void* user) {
  return static_cast<std::int64_t>(bytes_behind(user).size());
}

const exr_attribute_t* attribute(const ExrContext& file, int part, const char* name,
                                 exr_attribute_type_t type) {
  const exr_attribute_t* found = nullptr;
  const exr_result_t result = ::exr_get_attribute_by_name(file.get(), part, name, &found);
  return result == EXR_ERR_SUCCESS && found->type == type ? found : nullptr;
}

std::string text(const ExrContext& file, int part, const char* name) {
  const exr_attribute_t* found = attribute(file, part, name, EXR_ATTR_STRING);
  if (found == nullptr || found->string->length <= 0) return {};
  return {found->string->str, static_cast<std::size_t>(found->string->length)};
}

std::int32_t integer(const ExrContext& file, int part, const char* name) {
  const exr_attribute_t* found = attribute(file, part, name, EXR_ATTR_INT);
  return found == nullptr ? 0 : found->i;
}

/// OpenEXR multiplies row vectors from the left: the rows are images of the unit steps.
Affine affine_of(const double* rows) {
  Affine out;
  for (std::size_t row = 0; row < 3; ++row) {
    for (std::size_t column = 0; column < 4; ++column) {
      out.m[4 * row + column] = rows[4 * column + row];
    }
  }
  return out;
}

}  // namespace

ExrContext::ExrContext(std::string place, std::span<const std::byte> bytes)
    : place_(std::move(place)), bytes_(bytes) {
  exr_context_initializer_t start = EXR_DEFAULT_CONTEXT_INITIALIZER;
  start.error_handler_fn = note_message;
  start.user_data = &bytes_;
  start.read_fn = read_bytes;
  start.size_fn = count_bytes;
  check(::exr_start_read(&context_, place_.c_str(), &start));
}

ExrContext::~ExrContext() { ::exr_finish(&context_); }

void ExrContext::check(exr_result_t result) const {
  if (result == EXR_ERR_SUCCESS) return;
  if (result == EXR_ERR_OUT_OF_MEMORY) throw std::bad_alloc();
  std::string why = last_message.empty() ? ::exr_get_default_error_message(result) : last_message;
  last_message.clear();
  std::ranges::replace(why, '\n', ' ');
  throw Error(ErrorKind::input, place_, "damaged OpenEXR file: " + why);
}

std::optional<SliceNote> slice_note(const ExrContext& file, int part) {
  const exr_attribute_t* map = attribute(file, part, "mc_to_world", EXR_ATTR_M44D);
  if (map == nullptr) return std::nullopt;
  SliceNote note;
  Volume& volume = note.volume;
  std::array<double, 16> rows;
  std::memcpy(rows.data(), map->m44d, sizeof rows);
  volume.lattice.to_world = affine_of(rows.data());
  volume.name = text(file, part, "mc_name");
  volume.cls = field::class_named(text(file, part, "mc_class")).value_or(VolumeClass::unknown);
  volume.border = field::border_named(text(file, part, "mc_border"));
  if (const auto* iso = attribute(file, part, "mc_iso", EXR_ATTR_DOUBLE)) volume.iso = iso->d;
  const std::string frame = text(file, part, "mc_frame");
  volume.frame = frame == "lps" ? Frame::lps : frame == "ras" ? Frame::ras : Frame::none;
  const std::string units = text(file, part, "mc_units");
  volume.units = units == "mm" ? Units::mm : units == "m" ? Units::m : Units::unknown;
  note.index = integer(file, part, "mc_slice");
  note.count = integer(file, part, "mc_slices");
  return note;
}

}  // namespace mc::source

#endif
