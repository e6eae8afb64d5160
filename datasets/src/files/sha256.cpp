// SPDX-License-Identifier: GPL-3.0-or-later
#include "files/sha256.h"

#include <openssl/evp.h>

#include <array>
#include <stdexcept>

namespace exactvo::datasets {
namespace {

/// libcrypto refuses nothing that is asked of it here, unless it is out of memory or built without SHA-256.
void require(bool worked) {
  if (!worked) throw std::runtime_error("libcrypto computes no SHA-256");
}

}  // namespace

Sha256::Sha256() : context_(EVP_MD_CTX_new(), EVP_MD_CTX_free) {
  require(context_ && EVP_DigestInit_ex(context_.get(), EVP_sha256(), nullptr) == 1);
}

void Sha256::add(std::string_view bytes) {
  require(EVP_DigestUpdate(context_.get(), bytes.data(), bytes.size()) == 1);
}

std::string Sha256::digest() {
  std::array<unsigned char, EVP_MAX_MD_SIZE> raw{};
  unsigned int length = 0;
  require(EVP_DigestFinal_ex(context_.get(), raw.data(), &length) == 1);
  std::string text;
  for (unsigned int k = 0; k < length; ++k) {
    text += "0123456789abcdef"[raw[k] >> 4];
    text += "0123456789abcdef"[raw[k] & 0xf];
  }
  return text;
}

}  // namespace exactvo::datasets
