// SPDX-License-Identifier: GPL-3.0-or-later
#include <charconv>

#include "smoothing/base/input_error.h"
#include "studies/kinds/collection/definition/collection.h"

namespace smoothfem {

namespace {

/// FNV-1a, which has the same value on every machine. std::hash need not.
std::uint64_t hash_of(const std::string& text) {
  constexpr std::uint64_t basis = 14695981039346656037ULL, prime = 1099511628211ULL;
  std::uint64_t hash = basis;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * prime;
  return hash;
}

}  // namespace

Shard Shard::parse(const std::string& text) {
  Shard shard;
  const char *begin = text.data(), *end = begin + text.size();
  const auto first = std::from_chars(begin, end, shard.k);
  const bool has_slash = first.ec == std::errc() && first.ptr != end && *first.ptr == '/';
  const auto second = has_slash ? std::from_chars(first.ptr + 1, end, shard.n) : first;
  if (!has_slash || second.ec != std::errc() || second.ptr != end || shard.k < 1 ||
      shard.k > shard.n)
    throw InputError("--shard is '" + text +
                     "'; write the part and the number of parts, for example 1/10 to 10/10");
  return shard;
}

bool Shard::holds(const Member& member) const {
  return hash_of(member.mesh.name) % n == k - 1;
}

}  // namespace smoothfem
