// SPDX-License-Identifier: MIT
#define HWY_WANT_AVX3_DL 1
#include "hwy/targets.h"

// What Highway asks for at run time: which targets this machine offers, which is chosen, and where
// an assertion of a debug build fails. Highway's own library answers, but times its clock for its
// benchmarks when it is loaded, which takes longer than a small run of ours: 5 ms. On x86 it is
// therefore not linked.
//
// Every file that includes Highway wants AVX3_DL: the choice of a target is an inline function that
// knows which targets its file was compiled for, and where it is not inlined all files share one.
//
// Source   Highway 1.0.3, hwy/targets.cc. The definitions are weak: a program that links the
// library for itself keeps it.

#if HWY_ARCH_X86

#include <cpuid.h>

#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace {

/// Bits of the words that the instruction CPUID gives, by leaf and register.
struct CpuBits {
  std::uint32_t leaf1_ecx = 0, leaf7_ebx = 0, leaf7_ecx = 0, extended_ecx = 0;
  std::uint32_t saved = 0;  ///< which registers the system saves for programs
};

CpuBits cpu_bits() {
  CpuBits bits;
  std::uint32_t eax = 0, ebx = 0, edx = 0, unused = 0;
  __get_cpuid(1, &eax, &ebx, &bits.leaf1_ecx, &edx);
  __get_cpuid_count(7, 0, &eax, &bits.leaf7_ebx, &bits.leaf7_ecx, &edx);
  __get_cpuid(0x80000001U, &eax, &ebx, &bits.extended_ecx, &edx);
  constexpr std::uint32_t kXgetbv = 1U << 27U;
  if ((bits.leaf1_ecx & kXgetbv) != 0) {
    asm volatile("xgetbv" : "=a"(bits.saved), "=d"(unused) : "c"(0));
  }
  return bits;
}

constexpr std::uint32_t mask_of(auto... bits) { return ((std::uint32_t{1} << bits) | ...); }

bool all(std::uint32_t word, std::uint32_t mask) { return (word & mask) == mask; }

/// Each target needs all that those before it need.
std::int64_t detected_targets() {
  const CpuBits cpu = cpu_bits();
  std::int64_t targets = HWY_SCALAR | HWY_EMU128;
  if (!all(cpu.leaf1_ecx, mask_of(0, 9))) return targets;  // SSE3, SSSE3
  targets |= HWY_SSSE3;
  if (!all(cpu.leaf1_ecx, mask_of(1, 19, 20, 25))) return targets;  // CLMUL, SSE 4.1 and 4.2, AES
  targets |= HWY_SSE4;
  if (!all(cpu.saved, mask_of(1, 2)) ||
      !all(cpu.leaf1_ecx, mask_of(12, 28, 29)) ||  // FMA, AVX, F16C
      !all(cpu.leaf7_ebx, mask_of(3, 5, 8)) ||     // BMI, AVX2, BMI2
      !all(cpu.extended_ecx, mask_of(5))) {        // LZCNT
    return targets;
  }
  targets |= HWY_AVX2;
  if (!all(cpu.saved, mask_of(5, 6, 7)) ||
      !all(cpu.leaf7_ebx, mask_of(16, 17, 30, 31))) {  // AVX-512 F, DQ, BW, VL
    return targets;
  }
  targets |= HWY_AVX3;
  // VBMI, VBMI2, GFNI, VAES, VPCLMULQDQ, VNNI, BITALG, VPOPCNTDQ
  return all(cpu.leaf7_ecx, mask_of(1, 6, 8, 9, 10, 11, 12, 14)) ? targets | HWY_AVX3_DL : targets;
}

}  // namespace

namespace hwy {

__attribute__((weak)) int64_t SupportedTargets() {
  static const std::int64_t targets = detected_targets();
  return targets;
}

__attribute__((weak)) ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

__attribute__((weak)) void Abort(const char* file, int line, const char* format, ...) {
  std::va_list values;
  va_start(values, format);
  std::fprintf(stderr, "%s:%d: ", file, line);
  std::vfprintf(stderr, format, values);
  std::fputc('\n', stderr);
  va_end(values);
  std::abort();
}

}  // namespace hwy

#endif
