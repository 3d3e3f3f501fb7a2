#pragma once

#include <weave/core/result.hpp>
#include <weave/keys/hash.hpp>

#include <cstdint>
#include <functional>
#include <string_view>
#include <utility>
#include <vector>

namespace weave::loomlink {

/// The Merkle tree of the log after RFC 9162, section 2.1, with SHA-256: a leaf is hashed behind a byte 0, a
/// node behind a byte 1, and a tree of n leaves is split at the largest power of two below n.

/// The largest tree that proofs are made or looked at for.
inline constexpr std::uint64_t most_leaves = std::uint64_t{1} << 62;

Hash leaf_hash(std::string_view record);
Hash node_hash(const Hash& left, const Hash& right);

/// The root of a tree without leaves: SHA-256 of nothing.
Hash empty_root();

/// A complete subtree: the one of the 2^level leaves from number `index * 2^level` on. Level 0 are the
/// leaves.
struct NodePlace {
    unsigned level = 0;
    std::uint64_t index = 0;
    friend bool operator==(const NodePlace&, const NodePlace&) = default;
    friend auto operator<=>(const NodePlace&, const NodePlace&) = default;
};

/// Where the hashes of complete subtrees are kept.
using NodeReader = std::function<Result<Hash>(NodePlace)>;

/// The nodes that become complete when `leaf` is added to a tree of `size` leaves, the leaf itself first;
/// about one on average, log2(size) at most. `node` is asked for left neighbours that are complete already.
Result<std::vector<std::pair<NodePlace, Hash>>> append_leaf(std::uint64_t size, const Hash& leaf,
                                                            const NodeReader& node);

/// The root of the first `size` leaves; asks for log2(size) nodes.
Result<Hash> tree_root(std::uint64_t size, const NodeReader& node);

/// The root of all these leaves.
Hash root_of(const std::vector<Hash>& leaves);

/// The way from leaf `index` to the root of the first `size` leaves (RFC 9162, 2.1.3.1), the leaf's neighbour
/// first. An error where the tree has no such leaf.
Result<std::vector<Hash>> inclusion_proof(std::uint64_t index, std::uint64_t size, const NodeReader& node);

/// What shows that the first `size` leaves begin with the first `old_size` (RFC 9162, 2.1.4.1); empty where
/// both are the same. An error where `old_size` is 0 or more than `size`.
Result<std::vector<Hash>> consistency_proof(std::uint64_t old_size, std::uint64_t size,
                                            const NodeReader& node);

/// Whether the proof leads from the leaf's hash at `index` to the root of a tree of `size` leaves (RFC
/// 9162, 2.1.3.2).
[[nodiscard]] bool verify_inclusion(std::uint64_t index, std::uint64_t size, const Hash& leaf,
                                    const std::vector<Hash>& proof, const Hash& root);

/// Whether the proof shows that the tree of `size` leaves is that of `old_size` leaves with more behind (RFC
/// 9162, 2.1.4.2). Equal sizes need equal roots and an empty proof. Trees without leaves prove nothing:
/// false.
[[nodiscard]] bool verify_consistency(std::uint64_t old_size, const Hash& old_root, std::uint64_t size,
                                      const Hash& root, const std::vector<Hash>& proof);

}  // namespace weave::loomlink
