#include "audit_case.hpp"

#include <loomlink/audit/bundle.hpp>
#include <set>
#include <support/random.hpp>

using namespace weave;
using namespace weave::loomlink;
using namespace weave::loomlink::testing;
using weave::testing::Random;

namespace {

const TestKey log_key(1), person_key(2), thief_key(9);

BundleTrust trust_in(std::optional<SignedTreeHead> retained = {}) {
    return {log_key.check(), std::move(retained), person_key.check()};
}

std::string all_text(const BundleReport& report) {
    std::string text;
    for (const AuditFinding& finding : report.findings) text += finding.text() + "\n";
    return text;
}

/// The record or leaf line that byte `at` of the bundle lies in; nothing for the lines of the layout.
std::optional<std::uint64_t> record_at(const std::string& file, std::size_t at, std::size_t count) {
    const auto line = static_cast<std::size_t>(
        std::count(file.begin(), file.begin() + static_cast<std::ptrdiff_t>(at), '\n'));
    if (line >= 3 && line < 3 + count) return line - 3;
    if (line >= 5 + count && line < 5 + 2 * count) return line - 5 - count;
    return {};
}

/// The records of an attempt, and those of which at least one must be named; none: the damage lies in the
/// layout.
struct Attempt {
    std::string file;
    std::set<std::uint64_t> touched;
};

Attempt flip_a_bit(const AuditBundle& bundle, Random& random) {
    Attempt attempt{write_bundle(bundle), {}};
    const std::size_t at = random.between(0, attempt.file.size() - 1);
    if (const auto seq = record_at(attempt.file, at, bundle.records.size())) attempt.touched = {*seq};
    attempt.file[at] = static_cast<char>(attempt.file[at] ^ (1 << random.between(0, 7)));
    return attempt;
}

/// Deletes, swaps, doubles, replaces or rewrites a record, with its leaf or without.
Attempt change_records(AuditBundle bundle, Random& random) {
    const std::size_t a = random.between(0, bundle.records.size() - 2);
    const std::size_t b = random.between(a + 1, bundle.records.size() - 1);
    const bool leaves_too = random.coin();
    std::set<std::uint64_t> touched{a};
    const auto change = [&](auto& list, const auto& value, std::size_t way) {
        const auto at = list.begin() + static_cast<std::ptrdiff_t>(a);
        if (way == 0) list.erase(at);
        if (way == 1) std::swap(list[a], list[b]);
        if (way == 2) list.insert(at, list[a]);
        if (way == 3) list[a] = value;
    };
    const std::size_t way = random.between(0, 3);
    if (way == 1) touched.insert(b);
    EventRecord record = parse_record(bundle.records[a]).value();
    record.statement.actor = "mallory";
    if (record.signature) record.signature = thief_key.sign(statement_bytes(record.statement));
    const std::string other = record_bytes(record).value();
    change(bundle.records, other, way);
    if (leaves_too) {
        change(bundle.leaves, leaf_hash(other), way);
        touched.clear();  // leaves and records agree: the root tells that it is another log, not where
        if (way == 1 || way == 2 || (way == 0 && a + 1 < bundle.leaves.size() + 1)) touched = {a, a + 1, b};
        if (way == 0) touched = {a, bundle.leaves.size()};
        if (way == 3) touched = {a, a + 1};
        if (way == 3 && a + 1 == bundle.leaves.size()) touched.clear();
    }
    return {write_bundle(bundle), touched};
}

void expect_found(const Attempt& attempt, const BundleTrust& trust) {
    const BundleReport report = verify_bundle(attempt.file, trust);
    INFO(all_text(report));
    REQUIRE_FALSE(report.clean());
    if (attempt.touched.empty()) return;
    bool named = false;
    for (const std::uint64_t seq : attempt.touched) named = named || names_record(report.findings, seq);
    INFO("record " << *attempt.touched.begin());
    REQUIRE(named);
}

void tamper(std::size_t attempts) {
    const std::vector<std::string> records = make_records(40, person_key);
    const AuditBundle bundle = bundle_of(records, log_key);
    const BundleTrust trust = trust_in(bundle.head);
    REQUIRE(verify_bundle(write_bundle(bundle), trust).clean());
    weave::testing::for_all(
        [&](Random& random) {
            const std::size_t way = random.between(0, 9);
            if (way < 5) return expect_found(flip_a_bit(bundle, random), trust);
            if (way < 8) return expect_found(change_records(bundle, random), trust);
            if (way == 8) {  // an old copy, with the good head of its time
                const std::size_t size = random.between(1, 39);
                const AuditBundle old = bundle_of(
                    {records.begin(), records.begin() + static_cast<std::ptrdiff_t>(size)}, log_key);
                return expect_found({write_bundle(old), {size}}, trust);
            }
            std::string file = write_bundle(bundle);
            file.resize(random.between(0, file.size() - 1));
            expect_found({file, {}}, trust);
        },
        attempts);
}

}  // namespace

TEST_CASE("a bundle as it was written is clean, and is JSON") {
    for (const std::uint64_t count : {1, 2, 3, 17}) {
        const AuditBundle bundle = bundle_of(make_records(count, person_key), log_key);
        const std::string file = write_bundle(bundle);
        const BundleReport report = verify_bundle(file, trust_in(bundle.head));
        INFO(all_text(report));
        REQUIRE(report.clean());
        REQUIRE(report.records == count);
        REQUIRE(report.head == bundle.head);
        const Json json = parse_json(file).value();
        REQUIRE(json["records"].size() == count);
        REQUIRE(json["records"][0]["statement"]["actor"] == "anna");
    }
}

TEST_CASE("every single bit of a bundle matters, and its record is named") {
    const AuditBundle bundle = bundle_of(make_records(2, person_key), log_key);
    const std::string file = write_bundle(bundle);
    for (std::size_t at = 0; at < file.size(); ++at) {
        for (int bit = 0; bit < 8; ++bit) {
            std::string changed = file;
            changed[at] = static_cast<char>(changed[at] ^ (1 << bit));
            const BundleReport report = verify_bundle(changed, trust_in());
            INFO("byte " << at << ", bit " << bit << "\n" << all_text(report));
            REQUIRE_FALSE(report.clean());
            if (const auto seq = record_at(file, at, 2)) REQUIRE(names_record(report.findings, *seq));
        }
    }
}

TEST_CASE("random tampering with a bundle is found, and the record named") {
    tamper(300);
}

TEST_CASE("10,000 random tamperings with a bundle are found, and the record named", "[.][long]") {
    tamper(10000);
}

TEST_CASE("an older copy, a fork and a foreign log are found by the retained head alone") {
    const std::vector<std::string> records = make_records(20, person_key);
    const AuditBundle now = bundle_of(records, log_key);
    const AuditBundle old = bundle_of({records.begin(), records.begin() + 12}, log_key);
    REQUIRE(verify_bundle(write_bundle(now), trust_in(old.head)).clean());
    REQUIRE(verify_bundle(write_bundle(old), trust_in()).clean());  // without a retained head nothing tells
    REQUIRE_THAT(all_text(verify_bundle(write_bundle(old), trust_in(now.head))),
                 Catch::Contains("older copy"));

    std::vector<std::string> fork = make_records(20, person_key, "mill", 1);
    REQUIRE(verify_bundle(write_bundle(bundle_of(fork, log_key)), trust_in()).clean());
    REQUIRE_THAT(all_text(verify_bundle(write_bundle(bundle_of(fork, log_key)), trust_in(old.head))),
                 Catch::Contains("history was rewritten"));

    const AuditBundle foreign = bundle_of(make_records(20, person_key, "elsewhere"), log_key, "elsewhere");
    REQUIRE_THAT(all_text(verify_bundle(write_bundle(foreign), trust_in(old.head))),
                 Catch::Contains("another site"));
    SignedTreeHead forged = old.head;
    forged.signature = thief_key.sign(head_bytes(forged.head));
    REQUIRE_THAT(all_text(verify_bundle(write_bundle(now), trust_in(forged))),
                 Catch::Contains("retained head"));
}

TEST_CASE("a head that another key signed is not the log's") {
    AuditBundle bundle = bundle_of(make_records(5, person_key), thief_key);
    REQUIRE_THAT(all_text(verify_bundle(write_bundle(bundle), trust_in())),
                 Catch::Contains("not signed by the key"));
    bundle = bundle_of(make_records(5, person_key), log_key);
    bundle.head.head.at = "2026-11-27T10:00:00.000Z";
    REQUIRE_FALSE(verify_bundle(write_bundle(bundle), trust_in()).clean());
}

TEST_CASE("a log that its own server wrote wrongly is found as well") {
    const auto rewritten = [](auto change) {
        std::vector<std::string> records = make_records(6, person_key);
        EventRecord record = parse_record(records[4]).value();
        change(record);
        records[4] = record_bytes(record).value();
        return verify_bundle(write_bundle(bundle_of(records, log_key)), trust_in());
    };
    REQUIRE(names_record(rewritten([](EventRecord& record) { record.seq = 9; }).findings, 4));
    REQUIRE(names_record(rewritten([](EventRecord& record) { record.prev = Hash{}; }).findings, 4));
    REQUIRE(
        names_record(rewritten([](EventRecord& record) { record.statement.site = "other"; }).findings, 4));
    REQUIRE(names_record(
        rewritten([](EventRecord& record) { record.signature = thief_key.sign("x"); }).findings, 4));
    std::vector<std::string> records = make_records(3, person_key);
    records[1] += " ";
    REQUIRE(names_record(verify_bundle(write_bundle(bundle_of(records, log_key)), trust_in()).findings, 1));
}

TEST_CASE("a bundle of anything is looked at, and found wanting") {
    for (const std::string file : {"", "\n", "{}", "{}\n", "\n\n\n\n\n\n\n\n"})
        REQUIRE_FALSE(verify_bundle(file, trust_in()).clean());
    const BundleReport report = verify_bundle(std::string(100000, '\n'), trust_in());
    REQUIRE(report.findings.size() == most_findings);
    REQUIRE(report.unlisted > 0);
}
