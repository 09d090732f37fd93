// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <new>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

// What every room shares: the one error type, progress and its messages, views of arrays, and
// buffers that grow without being zeroed.

namespace mc {

/// What went wrong, by the exit status that mc(1) gives it.
enum class ErrorKind : std::uint8_t {
  internal = 1,  ///< a fault of this program
  usage = 2,     ///< command line, spec or script; found before any work
  input = 3,     ///< unreadable, damaged, or not what it claims to be
  output = 4,    ///< cannot be written
  empty = 5,     ///< no surface at that iso
  limit = 6,     ///< memory, or what a format can hold
  defect = 7,    ///< `check` found a defect
};

/// What a user can change about what an error or a note says. The library states facts; its caller
/// names the option or control that does this.
enum class Remedy : std::uint8_t {
  none,
  more_memory,     ///< a larger memory budget, or a smaller region
  smaller_region,  ///< fewer samples at a time
  close_border,    ///< Border::closed
  choose_grid,     ///< SourceOptions::grid
  choose_iso,      ///< an isovalue within the range of the data
  keep_smaller,    ///< KeepRule: a smaller size
};

/// The one exception of the library.
/// what() reads "PLACE: FAULT; REMEDY" on one line, lower case, without "mc: error: ".
class Error : public std::exception {
 public:
  /// `place` is a file, "file:line:column", an option; empty where there is none.
  /// `fault` says what is wrong against what was expected; `remedy` what to do next (may be empty).
  Error(ErrorKind kind, std::string_view place, std::string_view fault,
        std::string_view remedy = {});

  /// As above; `remedy` is left for the caller to put into words.
  Error(ErrorKind kind, std::string_view place, std::string_view fault, Remedy remedy);

  /// Several faults found together; each entry is a whole line "PLACE: FAULT; REMEDY".
  Error(ErrorKind kind, std::vector<std::string> lines);

  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  /// What the caller can suggest besides what lines() say.
  [[nodiscard]] Remedy remedy() const noexcept { return remedy_; }
  [[nodiscard]] const std::vector<std::string>& lines() const noexcept { return lines_; }
  [[nodiscard]] const char* what() const noexcept override { return lines_.front().c_str(); }

 private:
  ErrorKind kind_;
  Remedy remedy_ = Remedy::none;
  std::vector<std::string> lines_;  // never empty
};

/// Thrown when the caller's stop token asked for it.
class Cancelled : public std::exception {
 public:
  [[nodiscard]] const char* what() const noexcept override { return "cancelled"; }
};

/// Where a run tells its caller how far it is, and where notes and warnings go.
/// The library never prints. Threads: every member may be called from any thread.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A new stage starts; `total` units of `unit` ("samples", "bytes") lie ahead, 0 where unknown.
  virtual void begin(std::string_view stage, std::uint64_t total, std::string_view unit) = 0;
  virtual void advance(std::uint64_t done) = 0;
  /// The stage has ended.
  virtual void end_stage() {}
  /// Something worth knowing ("2 of 3 grids are not meshed: ...").
  virtual void note(std::string_view text) = 0;
  /// As above, with what a user can change about it.
  virtual void note_remedy(std::string_view text, Remedy /*remedy*/) { note(text); }
  /// Something for verbose output only ("copied to a temporary file").
  virtual void detail(std::string_view /*text*/) {}
  /// Something that may make the result other than wished; also goes into `--report`.
  virtual void warn(std::string_view text) = 0;
};

/// A Progress that drops everything.
Progress& silent_progress();

/// Leaves new elements uninitialised where the type allows it, so that a growing buffer is touched
/// only by who fills it. Memory starts on a cache line, as vectors like it.
template <class T>
struct UninitialisedAllocator {
  using value_type = T;
  static constexpr std::align_val_t kAlignment{64};

  UninitialisedAllocator() = default;
  template <class U>
  UninitialisedAllocator(const UninitialisedAllocator<U>& /*other*/) noexcept {}

  [[nodiscard]] T* allocate(std::size_t n) {
    if (n > static_cast<std::size_t>(-1) / sizeof(T)) {
      throw std::bad_array_new_length();
    }
    return static_cast<T*>(::operator new(n * sizeof(T), kAlignment));
  }
  void deallocate(T* at, std::size_t /*n*/) noexcept { ::operator delete(at, kAlignment); }

  template <class U>
  void construct(U* at) noexcept {
    ::new (static_cast<void*>(at)) U;
  }
  template <class U, class... Args>
  void construct(U* at, Args&&... args) {
    ::new (static_cast<void*>(at)) U(std::forward<Args>(args)...);
  }
  bool operator==(const UninitialisedAllocator& /*other*/) const = default;
};

/// A std::vector whose resize() does not zero.
template <class T>
using Buffer = std::vector<T, UninitialisedAllocator<T>>;

using Index3 = std::array<std::int32_t, 3>;  ///< i, j, k
using Vec3 = std::array<double, 3>;          ///< world x, y, z

/// A borrowed three-dimensional array; i runs fastest. Strides count elements.
template <class T>
struct View3 {
  T* data = nullptr;
  Index3 dims{};                  ///< samples along i, j, k
  std::ptrdiff_t row_stride = 0;  ///< from (i, j, k) to (i, j+1, k)
  std::ptrdiff_t plane_stride = 0;

  View3() = default;
  /// A contiguous array of dims[0]*dims[1]*dims[2] elements.
  View3(T* first, Index3 extent)
      : data(first),
        dims(extent),
        row_stride(extent[0]),
        plane_stride(std::ptrdiff_t{extent[0]} * extent[1]) {}
};

}  // namespace mc
