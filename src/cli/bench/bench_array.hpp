// SPDX-License-Identifier: MIT
#pragma once

#include <sys/mman.h>

#include <cstddef>
#include <new>
#include <utility>

// Memory for benchmarks, straight from the system.

namespace mc::cli {

/// Fresh zero pages, huge ones where the system has them.
class BenchArray {
 public:
  enum class Pages : bool { small, huge };

  BenchArray() = default;
  /// Errors   std::bad_alloc.
  explicit BenchArray(std::size_t n_bytes, Pages pages = Pages::huge) : n_bytes_(n_bytes) {
    void* at = ::mmap(nullptr, n_bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (at == MAP_FAILED) throw std::bad_alloc();
    data_ = static_cast<std::byte*>(at);
    // Advice that the system may ignore: slower then, never wrong.
    ::madvise(at, n_bytes, pages == Pages::huge ? MADV_HUGEPAGE : MADV_NOHUGEPAGE);
  }
  ~BenchArray() {
    if (data_ != nullptr) ::munmap(data_, n_bytes_);
  }
  BenchArray(BenchArray&& other) noexcept
      : data_(std::exchange(other.data_, nullptr)), n_bytes_(std::exchange(other.n_bytes_, 0)) {}
  BenchArray& operator=(BenchArray&& other) noexcept {
    std::swap(data_, other.data_);
    std::swap(n_bytes_, other.n_bytes_);
    return *this;
  }

  [[nodiscard]] std::byte* data() const { return data_; }
  [[nodiscard]] std::size_t size() const { return n_bytes_; }

 private:
  std::byte* data_ = nullptr;
  std::size_t n_bytes_ = 0;
};

}  // namespace mc::cli
