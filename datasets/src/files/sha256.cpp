// SPDX-License-Identifier: GPL-3.0-or-later
// The functions of OpenSSL 1: those of version 3 read its configuration and set up its providers first, which takes a
// millisecond of every run.
#define OPENSSL_SUPPRESS_DEPRECATED
#include "files/sha256.h"

#include <openssl/sha.h>

#include <array>

namespace exactvo::datasets {

// These functions always return 1.
Sha256::Sha256() : state_(std::make_unique<SHA256state_st>()) {
  SHA256_Init(state_.get());
}

Sha256::~Sha256() = default;

void Sha256::add(std::string_view bytes) {
  SHA256_Update(state_.get(), bytes.data(), bytes.size());
}

std::string Sha256::digest() {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> raw{};
  SHA256_Final(raw.data(), state_.get());
  std::string text;
  for (const unsigned char byte : raw) {
    text += "0123456789abcdef"[byte >> 4];
    text += "0123456789abcdef"[byte & 0xf];
  }
  return text;
}

}  // namespace exactvo::datasets
