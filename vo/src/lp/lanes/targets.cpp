// SPDX-License-Identifier: GPL-3.0-or-later
// Which SIMD targets this processor has, as the GNU C library found it. Compiled with Highway's headers under another
// name (cmake/ExactVOHighway.cmake), in place of its library; nothing where that is linked.
#ifdef hwy
#include <hwy/highway.h>

#include <sys/platform/x86.h>

#include <atomic>
#include <cstdarg>
#include <cstdint>
#include <cstdio>
#include <cstdlib>

namespace hwy {
namespace {

std::atomic<std::int64_t> targets_for_test{0};

/// Whether the C library found all of these usable when the program was loaded: another CPUID would leave a virtual
/// machine each time.
template <class... Features>
bool has(Features... features) {
  return (x86_cpu_active(features) && ...);
}

/// As Highway groups them: a target has all that the ones before it have.
std::int64_t detected_targets() {
  std::int64_t targets = HWY_SCALAR | HWY_EMU128;
  if (!has(x86_cpu_SSSE3)) return targets;
  targets |= HWY_SSSE3;
  if (!has(x86_cpu_SSE4_1, x86_cpu_SSE4_2, x86_cpu_PCLMULQDQ, x86_cpu_AES)) return targets;
  targets |= HWY_SSE4;
  if (!has(x86_cpu_AVX2, x86_cpu_FMA, x86_cpu_BMI1, x86_cpu_BMI2, x86_cpu_LZCNT, x86_cpu_F16C)) return targets;
  targets |= HWY_AVX2;
  if (!has(x86_cpu_AVX512F, x86_cpu_AVX512VL, x86_cpu_AVX512DQ, x86_cpu_AVX512BW)) return targets;
  targets |= HWY_AVX3;
  if (!has(x86_cpu_AVX512_VBMI, x86_cpu_AVX512_VBMI2, x86_cpu_GFNI, x86_cpu_VAES, x86_cpu_VPCLMULQDQ,
           x86_cpu_AVX512_VNNI, x86_cpu_AVX512_BITALG, x86_cpu_AVX512_VPOPCNTDQ))
    return targets;
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

/// Called by Highway's assertions, in builds that have them.
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
