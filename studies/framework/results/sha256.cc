// SPDX-License-Identifier: GPL-3.0-or-later
#include "studies/framework/results/sha256.h"

#include <openssl/evp.h>

#include <fstream>
#include <sstream>

namespace smoothfem {

std::string sha256(std::string_view content) {
  unsigned char digest[EVP_MAX_MD_SIZE];
  unsigned int length = 0;
  EVP_Digest(content.data(), content.size(), digest, &length, EVP_sha256(), nullptr);
  std::string text;
  for (unsigned int i = 0; i < length; ++i) {
    constexpr const char* digits = "0123456789abcdef";
    text += {digits[digest[i] >> 4], digits[digest[i] & 15]};
  }
  return text;
}

std::string sha256_of_file(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  if (!stream) return "";
  std::ostringstream content;
  content << stream.rdbuf();
  return sha256(content.view());
}

}  // namespace smoothfem
