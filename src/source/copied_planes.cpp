// SPDX-License-Identifier: MIT
#include "source/copied_planes.hpp"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <system_error>
#include <utility>

#include "source/live_mapping.hpp"

namespace mc::source {

CopiedPlanes::CopiedPlanes(const Volume& volume, const PlaneBytes& planes, std::string place,
                           std::size_t n_planes)
    : volume_(volume),
      planes_(planes),
      place_(std::move(place)),
      pool_(std::make_shared<PlanePool>(planes.n_bytes)),
      known_(static_cast<std::size_t>(volume.lattice.dims()[2])) {
  pool_->reserve(n_planes);
}

void CopiedPlanes::fill(std::int32_t k, std::byte* to) const {
  std::uint64_t at = planes_.offset + static_cast<std::uint64_t>(k) * planes_.n_bytes;
  std::size_t left = planes_.n_bytes;
  while (left > 0) {
    const ssize_t n = ::pread(planes_.descriptor, to, left, static_cast<off_t>(at));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) {
      throw Error(ErrorKind::input, place_,
                  "cannot read: " + std::generic_category().message(errno));
    }
    if (n == 0) throw became_shorter(place_);
    to += n;
    at += static_cast<std::uint64_t>(n);
    left -= static_cast<std::size_t>(n);
  }
}

void CopiedPlanes::read(std::int32_t k0, std::int32_t k1, Slab& out) const {
  std::vector<std::shared_ptr<Plane>> planes;
  {
    const std::lock_guard lock(mutex_);
    for (std::int32_t k = k0; k < k1; ++k) {
      std::weak_ptr<Plane>& known = known_[static_cast<std::size_t>(k)];
      planes.push_back(known.lock());
      if (!planes.back()) known = planes.back() = std::make_shared<Plane>();
    }
  }
  out.shared.clear();  // before others are read: their memory is used again
  out.sides.clear();
  out.k0 = k0;
  out.row_stride_bytes = planes_.n_bytes / static_cast<std::size_t>(volume_.lattice.dims()[1]);
  out.planes.clear();
  for (std::int32_t k = k0; k < k1; ++k) {
    const std::shared_ptr<Plane>& plane = planes[static_cast<std::size_t>(k - k0)];
    // Several threads may want the same plane: one reads it, the others wait for that.
    std::call_once(plane->filled, [&] {
      if (!plane->bytes) plane->bytes = pool_->take();
      fill(k, plane->bytes.get());
    });
    out.planes.push_back(plane->bytes.get());
    out.shared.emplace_back(plane, plane->bytes.get());
  }
}

namespace {

constexpr std::size_t kTrialBytes = std::size_t{1} << 20;
constexpr std::size_t kTrials = 2;

/// So that the trial reads all of the bytes, as the extraction does.
std::uint64_t sum_of(std::span<const std::byte> bytes) {
  std::uint64_t sum = 0;
  for (std::size_t at = 0; at + sizeof sum <= bytes.size(); at += sizeof sum) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, sizeof word);
    sum += word;
  }
  return sum;
}

/// Whether the system has all of a mapping's bytes in memory.
bool in_memory(std::span<const std::byte> mapped) {
  const auto page = static_cast<std::size_t>(::sysconf(_SC_PAGESIZE));
  const auto address = reinterpret_cast<std::uintptr_t>(mapped.data());
  const std::size_t before = address % page;
  const std::size_t n_bytes = before + mapped.size();
  std::vector<unsigned char> resident((n_bytes + page - 1) / page);
  // mincore() takes a pointer to data that it does not write.
  auto* const begin = const_cast<std::byte*>(mapped.data() - before);
  if (::mincore(begin, n_bytes, resident.data()) != 0) return false;
  return std::all_of(resident.begin(), resident.end(), [](unsigned char r) { return r & 1U; });
}

double seconds_since(std::chrono::steady_clock::time_point begin) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

}  // namespace

bool copies_faster(const PlaneBytes& planes, std::span<const std::byte> mapped) {
  // Of a smaller file, the trial's 4 MiB would be too large a part.
  constexpr std::size_t kAllTrials = 2 * kTrials * kTrialBytes;
  if (mapped.size() < 16 * kAllTrials || !in_memory(mapped.first(kAllTrials))) return false;
  Buffer<std::byte> copy(kTrialBytes);
  std::memset(copy.data(), 0, copy.size());  // its pages are there before the trial
  volatile std::uint64_t sum = 0;
  double copying = 0, mapping = 0;
  for (std::size_t at = 0; at < kAllTrials; at += 2 * kTrialBytes) {
    auto begin = std::chrono::steady_clock::now();
    const auto offset = static_cast<off_t>(planes.offset + at);
    if (::pread(planes.descriptor, copy.data(), kTrialBytes, offset) !=
        static_cast<ssize_t>(kTrialBytes)) {
      return false;
    }
    sum = sum + sum_of(copy);
    copying += seconds_since(begin);
    begin = std::chrono::steady_clock::now();
    sum = sum + sum_of(mapped.subspan(at + kTrialBytes, kTrialBytes));
    mapping += seconds_since(begin);
  }
  return copying < mapping;
}

}  // namespace mc::source
