#include <loomlink/audit/tree.hpp>

#include <bit>
#include <cassert>
#include <string>

namespace weave::loomlink {

namespace {

std::string_view view(const Hash& hash) {
    return {reinterpret_cast<const char*>(hash.data()), hash.size()};
}

/// The largest power of two below n, where a tree of n > 1 leaves is split.
std::uint64_t split(std::uint64_t n) {
    return std::bit_floor(n - 1);
}

/// The root of `count` leaves from `begin` on. Every tree that a split makes begins at a multiple of the
/// power of two at or above its size, so a complete one is a node that is kept.
Result<Hash> range_root(std::uint64_t begin, std::uint64_t count, const NodeReader& node) {
    if (std::has_single_bit(count)) {
        const auto level = static_cast<unsigned>(std::countr_zero(count));
        return node({level, begin >> level});
    }
    const std::uint64_t k = split(count);
    WEAVE_TRY(const Hash left, range_root(begin, k, node));
    WEAVE_TRY(const Hash right, range_root(begin + k, count - k, node));
    return node_hash(left, right);
}

/// PATH of RFC 9162 for the leaf `index` of the `count` leaves from `begin` on.
Status add_path(std::vector<Hash>& proof, std::uint64_t index, std::uint64_t begin, std::uint64_t count,
                const NodeReader& node) {
    if (count == 1) return {};
    const std::uint64_t k = split(count);
    const bool left = index < k;
    WEAVE_CHECK_OK(left ? add_path(proof, index, begin, k, node)
                        : add_path(proof, index - k, begin + k, count - k, node));
    WEAVE_TRY(const Hash other, left ? range_root(begin + k, count - k, node) : range_root(begin, k, node));
    proof.push_back(other);
    return {};
}

/// SUBPROOF of RFC 9162: `known` while the part looked at is the whole old tree, whose root the verifier has.
Status add_subproof(std::vector<Hash>& proof, std::uint64_t old_size, std::uint64_t begin,
                    std::uint64_t count, bool known, const NodeReader& node) {
    if (old_size == count) {
        if (known) return {};
        WEAVE_TRY(const Hash whole, range_root(begin, count, node));
        proof.push_back(whole);
        return {};
    }
    const std::uint64_t k = split(count);
    const bool left = old_size <= k;
    WEAVE_CHECK_OK(left ? add_subproof(proof, old_size, begin, k, known, node)
                        : add_subproof(proof, old_size - k, begin + k, count - k, false, node));
    WEAVE_TRY(const Hash other, left ? range_root(begin + k, count - k, node) : range_root(begin, k, node));
    proof.push_back(other);
    return {};
}

/// The place of a node in the tree looked at, and of the last node of its level, while a proof is followed
/// upwards.
struct Climb {
    std::uint64_t at;
    std::uint64_t last;

    void up() {
        at >>= 1;
        last >>= 1;
    }
    /// Whether the next hash of the proof stands to the left.
    [[nodiscard]] bool joins_left() const { return (at & 1) != 0 || at == last; }
    /// A last node without a right neighbour is the same node on the levels above, up to where it has a left
    /// one.
    void skip_lonely() {
        while ((at & 1) == 0 && at != 0) up();
    }
};

}  // namespace

Hash leaf_hash(std::string_view record) {
    std::string bytes(1, '\0');
    return sha256(bytes.append(record));
}

Hash node_hash(const Hash& left, const Hash& right) {
    std::string bytes(1, '\1');
    return sha256(bytes.append(view(left)).append(view(right)));
}

Hash empty_root() {
    return sha256({});
}

Result<std::vector<std::pair<NodePlace, Hash>>> append_leaf(std::uint64_t size, const Hash& leaf,
                                                            const NodeReader& node) {
    assert(size < most_leaves);
    std::vector<std::pair<NodePlace, Hash>> complete{{{0, size}, leaf}};
    std::uint64_t index = size;
    for (unsigned level = 0; (index & 1) == 1; ++level, index >>= 1) {  // a right child completes its parent
        WEAVE_TRY(const Hash left, node({level, index - 1}));
        complete.push_back({{level + 1, index >> 1}, node_hash(left, complete.back().second)});
    }
    return complete;
}

Result<Hash> tree_root(std::uint64_t size, const NodeReader& node) {
    assert(size <= most_leaves);
    if (size == 0) return empty_root();
    return range_root(0, size, node);
}

Hash root_of(const std::vector<Hash>& leaves) {
    if (leaves.empty()) return empty_root();
    // Level by level; a node without a right neighbour rises as it is, which is the same tree.
    std::vector<Hash> level = leaves;
    while (level.size() > 1) {
        std::size_t made = 0;
        for (std::size_t k = 0; k < level.size(); k += 2)
            level[made++] = k + 1 < level.size() ? node_hash(level[k], level[k + 1]) : level[k];
        level.resize(made);
    }
    return level.front();
}

Result<std::vector<Hash>> inclusion_proof(std::uint64_t index, std::uint64_t size, const NodeReader& node) {
    if (index >= size || size > most_leaves)
        return bad_input("the tree of " + std::to_string(size) + " records has no record " +
                         std::to_string(index));
    std::vector<Hash> proof;
    WEAVE_CHECK_OK(add_path(proof, index, 0, size, node));
    return proof;
}

Result<std::vector<Hash>> consistency_proof(std::uint64_t old_size, std::uint64_t size,
                                            const NodeReader& node) {
    if (old_size == 0 || old_size > size || size > most_leaves)
        return bad_input("there is no proof from a tree of " + std::to_string(old_size) +
                         " records to one of " + std::to_string(size));
    std::vector<Hash> proof;
    WEAVE_CHECK_OK(add_subproof(proof, old_size, 0, size, true, node));
    return proof;
}

bool verify_inclusion(std::uint64_t index, std::uint64_t size, const Hash& leaf,
                      const std::vector<Hash>& proof, const Hash& root) {
    if (index >= size || size > most_leaves) return false;
    Climb climb{index, size - 1};
    Hash hash = leaf;
    for (const Hash& other : proof) {
        if (climb.last == 0) return false;  // longer than the tree is high
        if (climb.joins_left()) {
            hash = node_hash(other, hash);
            climb.skip_lonely();
        } else {
            hash = node_hash(hash, other);
        }
        climb.up();
    }
    return climb.last == 0 && hash == root;
}

bool verify_consistency(std::uint64_t old_size, const Hash& old_root, std::uint64_t size, const Hash& root,
                        const std::vector<Hash>& proof) {
    if (old_size == 0 || old_size > size || size > most_leaves) return false;
    if (old_size == size) return proof.empty() && old_root == root;
    if (proof.empty()) return false;
    // An old tree that is complete is itself a node of the new one, so its root stands for the first hash.
    const bool complete = std::has_single_bit(old_size);
    Climb climb{old_size - 1, size - 1};
    while ((climb.at & 1) == 1) climb.up();
    Hash old_hash = complete ? old_root : proof.front();
    Hash hash = old_hash;
    for (std::size_t k = complete ? 0 : 1; k < proof.size(); ++k) {
        if (climb.last == 0) return false;
        if (climb.joins_left()) {
            old_hash = node_hash(proof[k], old_hash);
            hash = node_hash(proof[k], hash);
            climb.skip_lonely();
        } else {
            hash = node_hash(hash, proof[k]);
        }
        climb.up();
    }
    return climb.last == 0 && old_hash == old_root && hash == root;
}

}  // namespace weave::loomlink
