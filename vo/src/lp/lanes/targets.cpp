// SPDX-License-Identifier: GPL-3.0-or-later
// Which SIMD targets this processor has. Compiled with Highway's headers under another name
// (cmake/ExactVOHighway.cmake), in place of its library; nothing where that is linked.
#ifdef hwy
#include <hwy/highway.h>

#include <cpuid.h>

#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace hwy {
namespace {

std::atomic<std::int64_t> targets_for_test{0};

/// What __builtin_cpu_supports does not know in every compiler. Registers that the operating system keeps are not among
/// it: those of AVX2 and AVX-512 have been asked for.
bool has_feature(unsigned leaf, unsigned bit_of_ecx) {
  unsigned a = 0, b = 0, c = 0, d = 0;
  return __get_cpuid_count(leaf, 0, &a, &b, &c, &d) != 0 && (c >> bit_of_ecx & 1U) != 0;
}

/// As Highway groups them: a target has all that the ones before it have.
std::int64_t detected_targets() {
  constexpr unsigned kBasic = 1, kExtended = 7, kOfAmd = 0x80000001;
  __builtin_cpu_init();
  std::int64_t targets = HWY_SCALAR | HWY_EMU128;
  if (!__builtin_cpu_supports("ssse3")) return targets;
  targets |= HWY_SSSE3;
  if (!(__builtin_cpu_supports("sse4.1") && __builtin_cpu_supports("sse4.2") && has_feature(kBasic, 1) &&
        has_feature(kBasic, 25)))  // carry-less products, AES
    return targets;
  targets |= HWY_SSE4;
  if (!(__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma") && __builtin_cpu_supports("bmi") &&
        __builtin_cpu_supports("bmi2") && has_feature(kOfAmd, 5) && has_feature(kBasic, 29)))  // LZCNT, F16C
    return targets;
  targets |= HWY_AVX2;
  if (!(__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") && __builtin_cpu_supports("avx512dq") &&
        __builtin_cpu_supports("avx512bw")))
    return targets;
  targets |= HWY_AVX3;
  // VBMI, VBMI2, GFNI, VAES, VPCLMULQDQ, VNNI, BITALG, VPOPCNTDQ
  for (const unsigned bit : {1U, 6U, 8U, 9U, 10U, 11U, 12U, 14U})
    if (!has_feature(kExtended, bit)) return targets;
  return targets | HWY_AVX3_DL;
}

}  // namespace

std::int64_t SupportedTargets() {
  if (const std::int64_t targets = targets_for_test.load(); targets != 0) return targets;
  static const std::int64_t detected = detected_targets();
  return detected;
}

void SetSupportedTargetsForTest(std::int64_t targets) {
  targets_for_test.store(targets);
}

ChosenTarget& GetChosenTarget() {
  static ChosenTarget chosen;
  return chosen;
}

/// Of Highway's assertions, in builds that have them.
HWY_NORETURN void Abort(const char* file, int line, const char* format, ...) {
  std::fprintf(stderr, "%s:%d: ", file, line);
  va_list arguments;
  va_start(arguments, format);
  std::vfprintf(stderr, format, arguments);
  va_end(arguments);
  std::abort();
}

}  // namespace hwy
#endif
