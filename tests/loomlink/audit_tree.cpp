#include "audit_case.hpp"

#include <loomlink/audit/tree.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using weave::loomlink::testing::TestTree;
using weave::testing::Random;

namespace {

using Hashes = std::vector<Hash>;

std::size_t split_of(std::size_t n) {
    std::size_t k = 1;
    while (2 * k < n) k *= 2;
    return k;
}
Hashes part(const Hashes& all, std::size_t from, std::size_t to) {
    return {all.begin() + static_cast<std::ptrdiff_t>(from), all.begin() + static_cast<std::ptrdiff_t>(to)};
}
/// MTH, PATH and SUBPROOF, word for word as RFC 9162 defines them.
Hash defined_root(const Hashes& d) {
    if (d.empty()) return sha256("");
    if (d.size() == 1) return d.front();
    const std::size_t k = split_of(d.size());
    return node_hash(defined_root(part(d, 0, k)), defined_root(part(d, k, d.size())));
}
Hashes joined(Hashes list, const Hash& last) {
    list.push_back(last);
    return list;
}
Hashes defined_path(std::size_t m, const Hashes& d) {
    if (d.size() == 1) return {};
    const std::size_t k = split_of(d.size());
    if (m < k) return joined(defined_path(m, part(d, 0, k)), defined_root(part(d, k, d.size())));
    return joined(defined_path(m - k, part(d, k, d.size())), defined_root(part(d, 0, k)));
}
Hashes defined_subproof(std::size_t m, const Hashes& d, bool b) {
    if (m == d.size()) return b ? Hashes{} : Hashes{defined_root(d)};
    const std::size_t k = split_of(d.size());
    if (m <= k) return joined(defined_subproof(m, part(d, 0, k), b), defined_root(part(d, k, d.size())));
    return joined(defined_subproof(m - k, part(d, k, d.size()), false), defined_root(part(d, 0, k)));
}

std::string bytes_of(std::string_view hex) {
    std::string bytes(hex.size() / 2, '\0');
    for (std::size_t k = 0; k < bytes.size(); ++k)
        bytes[k] = static_cast<char>(std::stoi(std::string(hex.substr(2 * k, 2)), nullptr, 16));
    return bytes;
}

TestTree tree_of(std::size_t count) {
    TestTree tree;
    for (std::size_t k = 0; k < count; ++k) tree.add(leaf_hash("record " + std::to_string(k)));
    return tree;
}

}  // namespace

TEST_CASE("roots and proofs are those of the test vectors of Certificate Transparency") {
    TestTree tree;
    const std::vector<std::string> roots{"6e340b9cffb37a989ca544e6bb780a2c78901d3fb33738768511a30617afa01d",
                                         "fac54203e7cc696cf0dfcb42c92a1d9dbaf70ad9e621f4bd8d98662f00e3c125",
                                         "aeb6bcfe274b70a14fb067a5e5578264db0fa9b51af5e0ba159158f329e06e77",
                                         "d37ee418976dd95753c1c73862b9398fa2a2cf9b4ff0fdfe8b30cd95209614b7",
                                         "4e3bbb1f7b478dcfe71fb631631519a3bca12c9aefca1612bfce4c13a86264d4",
                                         "76e67dadbcdf1e10e1b74ddc608abd2f98dfb16fbce75277b5232a127f2087ef",
                                         "ddb89be403809e325750d3d263cd78929c2942b7942a34b77e122c9594a74c8c",
                                         "5dc9da79a70659a9ad559cb701ded9a2ab9d823aad2f4960cfe370eff4604328"};
    const std::vector<std::string> inputs{
        "", "00", "10", "2021", "3031", "40414243", "5051525354555657", "606162636465666768696a6b6c6d6e6f"};
    REQUIRE(hash_hex(empty_root()) == "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
    for (std::size_t n = 1; n <= inputs.size(); ++n) {
        tree.add(leaf_hash(bytes_of(inputs[n - 1])));
        REQUIRE(hash_hex(tree_root(n, tree.reader()).value()) == roots[n - 1]);
    }
    const Hashes path = inclusion_proof(5, 8, tree.reader()).value();
    REQUIRE(path.size() == 3);
    REQUIRE(hash_hex(path[0]) == "bc1a0643b12e4d2d7c77918f44e0f4f79a838b6cf9ec5b5c283e1f4d88599e6b");
    REQUIRE(hash_hex(path[1]) == "ca854ea128ed050b41b35ffc1b87b8eb2bde461e9e3b5596ece6b9d5975a0ae0");
    REQUIRE(hash_hex(path[2]) == "d37ee418976dd95753c1c73862b9398fa2a2cf9b4ff0fdfe8b30cd95209614b7");
}

TEST_CASE("roots and proofs are those of the definition, for every tree up to 130 leaves") {
    const TestTree tree = tree_of(130);
    for (std::size_t n = 0; n <= 130; ++n) {
        const Hashes leaves = part(tree.leaves(), 0, n);
        const Hash root = defined_root(leaves);
        REQUIRE(tree_root(n, tree.reader()).value() == root);
        REQUIRE(root_of(leaves) == root);
        for (std::size_t m = 0; m < n; ++m) {
            const Hashes proof = inclusion_proof(m, n, tree.reader()).value();
            REQUIRE(proof == defined_path(m, leaves));
            REQUIRE(verify_inclusion(m, n, leaves[m], proof, root));
        }
        for (std::size_t m = 1; m <= n; ++m) {
            const Hashes proof = consistency_proof(m, n, tree.reader()).value();
            REQUIRE(proof == defined_subproof(m, leaves, true));
            REQUIRE(verify_consistency(m, defined_root(part(leaves, 0, m)), n, root, proof));
        }
    }
}

TEST_CASE("a tree keeps fewer than two nodes a leaf") {
    REQUIRE(tree_of(1000).kept() < 2000);
}

TEST_CASE("no proof is made for what a tree does not have") {
    const TestTree tree = tree_of(5);
    REQUIRE_FALSE(inclusion_proof(5, 5, tree.reader()));
    REQUIRE_FALSE(inclusion_proof(0, 0, tree.reader()));
    REQUIRE_FALSE(consistency_proof(0, 5, tree.reader()));
    REQUIRE_FALSE(consistency_proof(6, 5, tree.reader()));
    REQUIRE_FALSE(inclusion_proof(2, 9, tree.reader()));  // nodes that are missing are told, not made up
}

TEST_CASE("a forged, truncated, extended, foreign or replayed inclusion proof is not accepted") {
    const TestTree tree = tree_of(140);
    weave::testing::for_all([&](Random& random) {
        const std::size_t n = random.between(1, 130);
        const std::size_t m = random.between(0, n - 1);
        const Hash root = tree_root(n, tree.reader()).value();
        const Hash leaf = tree.leaves()[m];
        const Hashes proof = inclusion_proof(m, n, tree.reader()).value();
        REQUIRE(verify_inclusion(m, n, leaf, proof, root));

        Hashes forged = proof;
        if (!forged.empty()) {
            forged[random.between(0, forged.size() - 1)][random.between(0, 31)] ^=
                static_cast<unsigned char>(1U << random.between(0, 7));
            REQUIRE_FALSE(verify_inclusion(m, n, leaf, forged, root));
            REQUIRE_FALSE(verify_inclusion(m, n, leaf, part(proof, 0, proof.size() - 1), root));
            REQUIRE_FALSE(verify_inclusion(m, n, leaf, part(proof, 1, proof.size()), root));
        }
        REQUIRE_FALSE(verify_inclusion(m, n, leaf, joined(proof, leaf), root));
        REQUIRE_FALSE(verify_inclusion(m, n, leaf, joined(proof, root), root));
        REQUIRE_FALSE(verify_inclusion(m, n, tree.leaves()[(m + 1) % 140], proof, root));
        const std::size_t other = random.between(0, n - 1);
        if (other != m) REQUIRE_FALSE(verify_inclusion(other, n, leaf, proof, root));
        REQUIRE_FALSE(verify_inclusion(m, n, leaf, proof, tree_root(n + 1, tree.reader()).value()));
        REQUIRE_FALSE(verify_inclusion(n, n, leaf, proof, root));
        REQUIRE_FALSE(verify_inclusion(m, 0, leaf, proof, root));
        REQUIRE_FALSE(verify_inclusion(UINT64_MAX - 1, UINT64_MAX, leaf, proof, root));
        // a node of the tree shown as if it were a leaf of a smaller one: the leaf's own byte stands against
        // it
        if (!proof.empty()) REQUIRE(leaf_hash(std::string(64, 'x')) != node_hash(leaf, leaf));
    });
}

TEST_CASE("a forged, truncated, extended, foreign or replayed consistency proof is not accepted") {
    const TestTree tree = tree_of(140);
    TestTree fork;
    for (std::size_t k = 0; k < 140; ++k) fork.add(leaf_hash("other " + std::to_string(k)));
    weave::testing::for_all([&](Random& random) {
        const std::size_t n = random.between(2, 130);
        const std::size_t m = random.between(1, n - 1);
        const Hash root = tree_root(n, tree.reader()).value();
        const Hash old_root = tree_root(m, tree.reader()).value();
        const Hashes proof = consistency_proof(m, n, tree.reader()).value();
        REQUIRE(verify_consistency(m, old_root, n, root, proof));

        Hashes forged = proof;
        forged[random.between(0, forged.size() - 1)][random.between(0, 31)] ^=
            static_cast<unsigned char>(1U << random.between(0, 7));
        REQUIRE_FALSE(verify_consistency(m, old_root, n, root, forged));
        REQUIRE_FALSE(verify_consistency(m, old_root, n, root, part(proof, 0, proof.size() - 1)));
        REQUIRE_FALSE(verify_consistency(m, old_root, n, root, part(proof, 1, proof.size())));
        REQUIRE_FALSE(verify_consistency(m, old_root, n, root, joined(proof, root)));
        REQUIRE_FALSE(verify_consistency(m, old_root, n, root, {}));
        const Hash fork_root = tree_root(n, fork.reader()).value();
        const Hash fork_old = tree_root(m, fork.reader()).value();
        const Hashes fork_proof = consistency_proof(m, n, fork.reader()).value();
        REQUIRE_FALSE(verify_consistency(m, old_root, n, fork_root, fork_proof));
        REQUIRE_FALSE(verify_consistency(m, old_root, n, fork_root, proof));
        REQUIRE_FALSE(verify_consistency(m, fork_old, n, root, proof));
        REQUIRE_FALSE(verify_consistency(m, old_root, n + 1, tree_root(n + 1, tree.reader()).value(), proof));
        REQUIRE_FALSE(verify_consistency(n, root, m, old_root, proof));
        REQUIRE_FALSE(verify_consistency(0, old_root, n, root, proof));
        REQUIRE_FALSE(verify_consistency(0, empty_root(), n, root, {}));
        REQUIRE_FALSE(verify_consistency(0, empty_root(), 0, empty_root(), {}));
        REQUIRE_FALSE(verify_consistency(n, root, n, fork_root, {}));
        REQUIRE_FALSE(verify_consistency(n, root, n, root, proof));
        REQUIRE_FALSE(verify_consistency(m, old_root, UINT64_MAX, root, proof));
    });
}
