// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// SHA-256 (FIPS 180-4) of bytes that come in pieces, by OpenSSL's libcrypto.

#include <memory>
#include <string>
#include <string_view>

struct evp_md_ctx_st;  // OpenSSL's EVP_MD_CTX

namespace exactvo::datasets {

class Sha256 {
 public:
  Sha256();

  void add(std::string_view bytes);
  /// Lower-case hexadecimal. The object can't be used afterwards.
  std::string digest();

 private:
  std::unique_ptr<evp_md_ctx_st, void (*)(evp_md_ctx_st*)> context_;
};

}  // namespace exactvo::datasets
