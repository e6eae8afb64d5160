// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

/// \file
/// SHA-256 (FIPS 180-4) of bytes that come in pieces, by OpenSSL's libcrypto.

#include <memory>
#include <string>
#include <string_view>

struct SHA256state_st;  // OpenSSL's SHA256_CTX

namespace exactvo::datasets {

class Sha256 {
 public:
  Sha256();
  ~Sha256();

  void add(std::string_view bytes);
  /// Lower-case hexadecimal. The object can't be used afterwards.
  std::string digest();

 private:
  std::unique_ptr<SHA256state_st> state_;
};

}  // namespace exactvo::datasets
