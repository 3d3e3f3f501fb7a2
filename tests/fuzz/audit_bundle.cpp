// A bundle of the log from anywhere; records from anywhere under a sound head; and a sound bundle with some
// bytes in other places' stead: it is clean only if each record is one, and no byte differs.
#include "support/must.hpp"
#include "support/signed.hpp"

#include <algorithm>
#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/told_keys.hpp>
#include <loomlink/audit/tree.hpp>

using namespace weave;
using namespace weave::loomlink;
using fuzz::must;

namespace {

const BundleTrust& log_trust() {
    static const BundleTrust trust{[](std::string_view bytes, const RecordSignature& signature) {
                                       return verify(fuzz::one_key(Role::log).public_key(),
                                                     Purpose::tree_head, bytes,
                                                     {signature.key, signature.value});
                                   },
                                   {},
                                   {}};
    return trust;
}

/// These records, whatever they are, under a head that the log's key signed.
AuditBundle headed(std::vector<std::string> records) {
    AuditBundle bundle;
    for (const std::string& record : records) bundle.leaves.push_back(leaf_hash(record));
    bundle.records = std::move(records);
    const TreeHead head{"mill", bundle.leaves.size(), root_of(bundle.leaves), "2026-11-26T10:00:00.000Z"};
    const Signature signature = fuzz::one_key(Role::log).sign(Purpose::tree_head, head_bytes(head));
    bundle.head = {head, {signature.key, signature.value}};
    return bundle;
}

void try_records(std::string_view text) {
    std::vector<std::string> records;
    for (std::size_t from = 0; from < text.size() && records.size() < 64;) {
        const std::size_t end = std::min(text.find('\n', from), text.size());
        records.emplace_back(text.substr(from, end - from));
        from = end + 1;
    }
    if (records.empty()) return;
    const AuditBundle bundle = headed(records);
    if (!verify_bundle(write_bundle(bundle), log_trust()).clean()) return;
    Hash prev{};
    for (std::size_t k = 0; k < records.size(); ++k) {
        const auto record = parse_record(records[k]);
        must(record && record->seq == k && record->prev == prev && record->statement.site == "mill",
             "a clean bundle is a log");
        prev = leaf_hash(records[k]);
    }
}

const std::string& sound_file() {
    static const std::string file = [] {
        std::vector<std::string> records;
        Hash prev{};
        for (std::uint64_t seq = 0; seq < 3; ++seq) {
            const Statement statement{"mill", "note",        "2026-11-26T09:30:00.000Z", "anna", {}, {},
                                      "r",    Json::object()};
            records.push_back(record_bytes({seq, prev, statement, {}}).value());
            prev = leaf_hash(records.back());
        }
        std::string written = write_bundle(headed(records));
        must(verify_bundle(written, log_trust()).clean(), "the bundle to begin with is sound");
        return written;
    }();
    return file;
}

/// The text in the stead of as many bytes of a sound bundle, or between them, where its first bytes say.
void try_splice(std::string_view text) {
    if (text.size() < 3) return;
    const auto byte = [&](std::size_t k) {
        return static_cast<std::size_t>(static_cast<unsigned char>(text[k]));
    };
    const std::size_t at = (byte(0) * 256 + byte(1)) % sound_file().size();
    const std::string_view rest = text.substr(3);
    std::string file = sound_file();
    file.replace(at, byte(2) % 2 == 0 ? rest.size() : 0, rest);
    must(file == sound_file() || !verify_bundle(file, log_trust()).clean(), "no byte differs unseen");
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    const std::string_view text = fuzz::text_of(data, size);
    const BundleReport report = verify_bundle(text, log_trust());
    for (const AuditFinding& finding : report.findings)
        must(!finding.place.empty() && !finding.cause.empty(), "a finding says where and what");
    for (const auto& [id, told] : told_keys(text))
        must(key_id(told.key) == id, "a key has the id that it was told with");
    try_records(text);
    try_splice(text);
    return 0;
}
