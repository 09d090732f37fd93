// SPDX-License-Identifier: MIT
#pragma once

#include <malloc.h>
#include <sys/mman.h>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <new>
#include <stdexcept>
#include <string>

// What the programs that scripts/bench compares have in common: each holds its volume, says so, and
// then makes one mesh for each line of its stdin, so that the script can let them take turns. No
// code of mc's is needed, so that a peer is built without it.

namespace peer {

struct Counts {
  std::uint64_t n_vertices = 0;
  std::uint64_t n_faces = 0;
};

/// Answers each line of stdin with "SECONDS VERTICES FACES" of one round: `prepare`, then
/// `extract`, which is all that is timed. A first round, which warms up, is made before "ready" is
/// said.
template <class Prepare, class Extract>
void serve(Prepare&& prepare, Extract&& extract) {
  prepare();
  extract();
  std::puts("ready");
  std::fflush(stdout);
  for (int c = std::getchar(); c != EOF; c = std::getchar()) {
    if (c != '\n') continue;
    prepare();
    const auto began = std::chrono::steady_clock::now();
    const Counts counts = extract();
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - began;
    std::printf("%.9f %llu %llu\n", took.count(),
                static_cast<unsigned long long>(counts.n_vertices),
                static_cast<unsigned long long>(counts.n_faces));
    std::fflush(stdout);
  }
}

/// Reads a raw file of floats.
inline void load(const std::string& path, float* to, std::size_t n_samples) {
  const std::size_t n_bytes = n_samples * sizeof(float);
  std::FILE* file = std::fopen(path.c_str(), "rb");
  if (file == nullptr || std::fread(to, 1, n_bytes, file) != n_bytes) {
    throw std::runtime_error(path + ": cannot read " + std::to_string(n_bytes) + " bytes");
  }
  std::fclose(file);
}

/// The same into huge pages of this process's own, for good.
inline float* load(const std::string& path, std::size_t n_samples) {
  void* at = ::mmap(nullptr, n_samples * sizeof(float), PROT_READ | PROT_WRITE,
                    MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (at == MAP_FAILED) throw std::bad_alloc();
  ::madvise(at, n_samples * sizeof(float), MADV_HUGEPAGE);
  load(path, static_cast<float*>(at), n_samples);
  return static_cast<float*>(at);
}

/// Tells glibc to keep what is freed, so that the next round finds its pages mapped: the fair
/// baseline for a loop.
inline void keep_heap() {
  mallopt(M_MMAP_MAX, 0);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  mallopt(M_TOP_PAD, 64 << 20);
}

/// Runs main's body: what it throws goes to stderr, and the status is 1.
template <class Body>
int guarded(Body&& body) {
  try {
    body();
    return 0;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
  }
}

}  // namespace peer
