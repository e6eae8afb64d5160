// SPDX-License-Identifier: GPL-3.0-or-later
#include "explorer/packed_columns.h"

#include <cstring>

namespace exactvo::tools {

template <class Word>
void PackedColumns::append(const char* name, const char* type, std::size_t stride, const std::vector<Word>& words) {
  names_.push_back({{"name", name}, {"type", type}, {"count", words.size()}, {"stride", stride}});
  const std::size_t begin = bytes_.size();
  bytes_.resize(begin + words.size() * sizeof(Word));
  for (std::size_t plane = 0; plane < sizeof(Word); ++plane)
    for (std::size_t k = 0; k < words.size(); ++k)
      bytes_[begin + plane * words.size() + k] = static_cast<char>(static_cast<std::uint64_t>(words[k]) >> (8 * plane));
  bytes_.resize((bytes_.size() + 7) / 8 * 8);
}

void PackedColumns::add(const char* name, const std::vector<double>& values, std::size_t stride) {
  std::vector<std::uint64_t> bits(values.size());
  if (!values.empty()) std::memcpy(bits.data(), values.data(), 8 * values.size());
  const std::vector<std::uint64_t> plain = bits;
  if (stride > 0)
    for (std::size_t k = stride; k < bits.size(); ++k) bits[k] ^= plain[k - stride];
  append(name, "f64", stride, bits);
}

void PackedColumns::add(const char* name, const std::vector<std::int32_t>& values, std::size_t stride) {
  std::vector<std::uint32_t> coded(values.size());
  for (std::size_t k = 0; k < values.size(); ++k) {
    const auto at = [&](std::size_t back) {
      return k < back * stride ? 0U : static_cast<std::uint32_t>(values[k - back * stride]);
    };
    const auto difference = static_cast<std::int32_t>(k < 2 * stride ? at(0) - at(1) : at(0) - 2 * at(1) + at(2));
    coded[k] = (static_cast<std::uint32_t>(difference) << 1) ^ static_cast<std::uint32_t>(difference >> 31);
  }
  append(name, "i32", stride, coded);
}

void PackedColumns::add(const char* name, const std::vector<std::uint32_t>& values) {
  append(name, "u32", 0, values);
}

void PackedColumns::add(const char* name, const std::vector<std::uint8_t>& values, std::size_t stride) {
  std::vector<std::uint8_t> coded = values;
  for (std::size_t k = stride; k < values.size() && stride > 0; ++k)
    coded[k] = static_cast<std::uint8_t>(values[k] - values[k - stride]);
  append(name, "u8", stride, coded);
}

}  // namespace exactvo::tools
