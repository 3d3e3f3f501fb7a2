// Heads of the log that are not what they say: nobody takes them, neither who holds a bundle nor a terminal.

#include "audit_case.hpp"
#include "site.hpp"

#include <functional>
#include <loomlink/terminal/check.hpp>
#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::Random;
using weave::testing::Site;

namespace {

constexpr std::uint64_t most_records = 24;

const TestKey& log_key() {
    static const TestKey key(1);
    return key;
}

/// A log as it grew, and another one of the same length that shares its beginning.
struct Logs {
    TestKey person{2}, thief{9};
    std::vector<std::string> records = make_records(most_records, person);
    std::vector<std::string> fork = make_records(most_records, person, "mill", 1);
    std::vector<Hash> leaves = leaves_of(records), fork_leaves = leaves_of(fork);
    BundleTrust trust{log_key().check(), {}, person.check()};

    static std::vector<Hash> leaves_of(const std::vector<std::string>& records) {
        std::vector<Hash> leaves;
        for (const std::string& record : records) leaves.push_back(leaf_hash(record));
        return leaves;
    }
    [[nodiscard]] AuditBundle bundle(std::uint64_t size) const {
        return bundle_of({records.begin(), records.begin() + static_cast<std::ptrdiff_t>(size)}, log_key());
    }
    /// The sound head of the first so many records of one of the logs.
    static SignedTreeHead head(const std::vector<Hash>& leaves, std::uint64_t size) {
        return sign_head(log_key(), {leaves.begin(), leaves.begin() + static_cast<std::ptrdiff_t>(size)});
    }
};

/// A head for a bundle of `size` records that its log never signed for them.
SignedTreeHead false_head(const Logs& logs, std::uint64_t size, Random& random) {
    SignedTreeHead head = Logs::head(logs.leaves, size);
    switch (random.between(0, 6)) {
        case 0:  // changed after it was signed
            head.head.root[random.between(0, 31)] ^= static_cast<unsigned char>(1U << random.between(0, 7));
            return head;
        case 1:
            head.head.at = "2026-11-27T10:00:00.000Z";
            return head;
        case 2:  // the root of these records under another size
            head.head.size += random.between(1, 9);
            return head;
        case 3:
            head.signature = logs.thief.sign(head_bytes(head.head));
            return head;
        case 4:  // of another site, by the very key
            return sign_head(log_key(),
                             {logs.leaves.begin(), logs.leaves.begin() + static_cast<std::ptrdiff_t>(size)},
                             "elsewhere");
        case 5:  // of another history, by the very key
            return Logs::head(logs.fork_leaves, size);
        default: {  // an older or a newer one
            std::uint64_t other = random.between(1, most_records - 1);
            if (other >= size) ++other;
            return Logs::head(logs.leaves, other);
        }
    }
}

/// The bytes of a bundle with a broken head line: some of it missing, or a bit turned.
std::string broken_head(const AuditBundle& bundle, Random& random) {
    std::string file = write_bundle(bundle);
    const std::size_t from = file.find('\n') + 1, size = file.find('\n', from) - from;
    const std::size_t at = from + random.between(0, size - 1);
    if (random.coin()) return file.erase(at, random.between(1, from + size - at));
    file[at] = static_cast<char>(file[at] ^ (1 << random.between(0, 7)));
    return file;
}

/// Heads that are not what they say, each with a bundle of records.
void offer_false_heads(std::size_t attempts) {
    const Logs logs;
    for (std::uint64_t size = 1; size <= most_records; ++size)
        REQUIRE(verify_bundle(write_bundle(logs.bundle(size)), logs.trust).clean());
    weave::testing::for_all(
        [&](Random& random) {
            const std::uint64_t size = random.between(1, most_records);
            AuditBundle bundle = logs.bundle(size);
            if (random.coin()) {
                REQUIRE_FALSE(verify_bundle(broken_head(bundle, random), logs.trust).clean());
                return;
            }
            bundle.head = false_head(logs, size, random);
            REQUIRE_FALSE(verify_bundle(write_bundle(bundle), logs.trust).clean());
        },
        attempts);
}

/// Sound bundles, each held to a head that is not of its past.
void offer_false_retained_heads(std::size_t attempts) {
    const Logs logs;
    weave::testing::for_all(
        [&](Random& random) {
            const std::uint64_t size = random.between(1, most_records);
            const std::string file = write_bundle(logs.bundle(size));
            BundleTrust trust = logs.trust;
            trust.retained = Logs::head(logs.leaves, random.between(1, size));
            REQUIRE(verify_bundle(file, trust).clean());
            switch (random.between(0, 2)) {
                case 0:
                    if (size == most_records) return;
                    trust.retained = Logs::head(logs.leaves, random.between(size + 1, most_records));
                    break;
                case 1:
                    trust.retained = Logs::head(logs.fork_leaves, random.between(1, size));
                    break;
                default:
                    trust.retained->signature = logs.thief.sign(head_bytes(trust.retained->head));
            }
            REQUIRE_FALSE(verify_bundle(file, trust).clean());
        },
        attempts);
}

/// Indexes, soundly stamped, that come with such a head.
void offer_false_heads_to_a_terminal(std::size_t attempts) {
    const Site site;
    const TerminalState state =
        check_index(site.terminal(), site.index(10, 2, 0), Site::at(1), Site::consistent).value().state;
    const auto taken = [&](const SignedLogHead& head, std::uint64_t epoch) {
        ReleaseIndex index = site.index_terms(epoch, 3, 30);
        index.tree_head = head;
        return bool(check_index(state, site.sign_index(index), Site::at(31), Site::consistent));
    };
    REQUIRE(taken(site.head(22, site.log), 20));
    weave::testing::for_all(
        [&](Random& random) {
            SignedLogHead head = site.head(random.between(12, 40), site.log);
            REQUIRE(taken(head, 11));
            switch (random.between(0, 5)) {
                case 0:  // changed after it was signed
                    head.head.size += random.between(1, 9);
                    head.head.root = Site::root_of(head.head.size);
                    break;
                case 1:
                    head.head.root = sha256_hex("another");
                    break;
                case 2:
                    head = site.head(head.head.size, random.coin() ? site.thief : site.stamp);
                    break;
                case 3:  // of another site, by the very key
                    head = sign_head(site.log, {"elsewhere", head.head.size, head.head.root, Site::at(0)});
                    break;
                case 4:  // of another history, by the very key
                    head = sign_head(site.log, {Site::name, head.head.size, sha256_hex("fork"), Site::at(0)});
                    break;
                default:  // one from before
                    head = site.head(11, site.log);
            }
            REQUIRE_FALSE(taken(head, 11));
        },
        attempts);
}

}  // namespace

TEST_CASE("a forged, truncated, foreign or replayed head is not accepted with any records") {
    offer_false_heads(500);
}

TEST_CASE("a sound bundle is refused by every retained head that is not of its own past") {
    offer_false_retained_heads(500);
}

TEST_CASE("a terminal takes no forged, foreign or replayed head, whoever stamped the index") {
    offer_false_heads_to_a_terminal(500);
}

TEST_CASE("of 10,000 heads that are not what they say, of each kind, none is accepted", "[.][long]") {
    offer_false_heads(10000);
    offer_false_retained_heads(10000);
    offer_false_heads_to_a_terminal(10000);
}
