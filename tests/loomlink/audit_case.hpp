#pragma once

#include <array>
#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/tree.hpp>
#include <map>
#include <sodium.h>
#include <stdexcept>
#include <string>
#include <vector>

namespace weave::loomlink::testing {

inline std::string hex_of(const unsigned char* bytes, std::size_t count) {
    std::string text(2 * count + 1, '\0');
    sodium_bin2hex(text.data(), text.size(), bytes, count);
    text.pop_back();
    return text;
}

/// An Ed25519 key of a test, by libsodium itself.
class TestKey {
  public:
    explicit TestKey(unsigned char seed_byte) {
        if (sodium_init() < 0) throw std::runtime_error("libsodium does not start");
        std::array<unsigned char, crypto_sign_SEEDBYTES> seed{};
        seed.fill(seed_byte);
        crypto_sign_seed_keypair(m_public.data(), m_secret.data(), seed.data());
    }

    [[nodiscard]] std::string id() const { return hex_of(m_public.data(), m_public.size()); }
    [[nodiscard]] RecordSignature sign(std::string_view bytes) const {
        std::array<unsigned char, crypto_sign_BYTES> value{};
        crypto_sign_detached(value.data(), nullptr, reinterpret_cast<const unsigned char*>(bytes.data()),
                             bytes.size(), m_secret.data());
        return {id(), hex_of(value.data(), value.size())};
    }
    [[nodiscard]] SignatureCheck check() const {
        return [key = m_public, name = id()](std::string_view bytes, const RecordSignature& signature) {
            std::array<unsigned char, crypto_sign_BYTES> value{};
            return signature.key == name &&
                   sodium_hex2bin(value.data(), value.size(), signature.value.data(), signature.value.size(),
                                  nullptr, nullptr, nullptr) == 0 &&
                   crypto_sign_verify_detached(value.data(),
                                               reinterpret_cast<const unsigned char*>(bytes.data()),
                                               bytes.size(), key.data()) == 0;
        };
    }

  private:
    std::array<unsigned char, crypto_sign_PUBLICKEYBYTES> m_public{};
    std::array<unsigned char, crypto_sign_SECRETKEYBYTES> m_secret{};
};

inline Statement statement_of(std::uint64_t number, const std::string& site = "mill") {
    Statement statement;
    statement.site = site;
    statement.kind = number % 3 == 0 ? "revision.submitted" : "comment.added";
    statement.at = "2026-11-26T09:30:00.000Z";
    statement.actor = "anna";
    statement.subject = "shoe/" + std::to_string(number);
    if (number % 2 == 0) statement.reason = "the \"toe\"\nis too loose, said J\xc3\xb6rg";
    statement.request = "r" + std::to_string(number);
    statement.data = {{"number", number}, {"pick", 1234.5}};
    return statement;
}

/// The complete subtrees of a log, kept in memory.
class TestTree {
  public:
    void add(const Hash& leaf) {
        const auto complete = append_leaf(m_leaves.size(), leaf, reader()).value();
        for (const auto& [place, hash] : complete) m_nodes[place] = hash;
        m_leaves.push_back(leaf);
    }
    [[nodiscard]] NodeReader reader() const {
        return [this](NodePlace place) -> Result<Hash> {
            const auto node = m_nodes.find(place);
            if (node == m_nodes.end()) return system_fault("no such node");
            return node->second;
        };
    }
    [[nodiscard]] const std::vector<Hash>& leaves() const { return m_leaves; }
    [[nodiscard]] std::size_t kept() const { return m_nodes.size(); }

  private:
    std::vector<Hash> m_leaves;
    std::map<NodePlace, Hash> m_nodes;
};

/// A log of `count` records, every third signed by `person`.
inline std::vector<std::string> make_records(std::uint64_t count, const TestKey& person,
                                             const std::string& site = "mill", std::uint64_t salt = 0) {
    std::vector<std::string> records;
    Hash prev{};
    for (std::uint64_t seq = 0; seq < count; ++seq) {
        EventRecord record{seq, prev, statement_of(seq + salt, site), {}};
        if (seq % 3 == 0) record.signature = person.sign(statement_bytes(record.statement));
        records.push_back(record_bytes(record).value());
        prev = leaf_hash(records.back());
    }
    return records;
}

inline SignedTreeHead sign_head(const TestKey& log, const std::vector<Hash>& leaves,
                                const std::string& site = "mill") {
    const TreeHead head{site, leaves.size(), root_of(leaves), "2026-11-26T10:00:00.000Z"};
    return {head, log.sign(head_bytes(head))};
}

/// The bundle of these records, with whatever they are.
inline AuditBundle bundle_of(std::vector<std::string> records, const TestKey& log,
                             const std::string& site = "mill") {
    AuditBundle bundle;
    for (const std::string& record : records) bundle.leaves.push_back(leaf_hash(record));
    bundle.records = std::move(records);
    bundle.head = sign_head(log, bundle.leaves, site);
    return bundle;
}

/// Whether one of the findings names the record.
inline bool names_record(const std::vector<AuditFinding>& findings, std::uint64_t seq) {
    for (const AuditFinding& finding : findings)
        if (finding.seq == seq) return true;
    return false;
}

}  // namespace weave::loomlink::testing
