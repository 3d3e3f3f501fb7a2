#include <weave/core/text.hpp>

#include <loomlink/audit/bundle.hpp>
#include <loomlink/audit/bundle_layout.hpp>
#include <loomlink/audit/tree.hpp>
#include <map>
#include <utility>

namespace weave::loomlink {

namespace {

/// An item of a list without the comma that ends all but the last; nothing where the comma is wrong.
std::optional<std::string_view> list_item(const std::vector<std::string_view>& items, std::size_t k) {
    std::string_view item = items[k];
    const bool last = k + 1 == items.size();
    if (last) return item.ends_with(',') ? std::nullopt : std::optional(item);
    if (!item.ends_with(',')) return {};
    item.remove_suffix(1);
    return item;
}

/// One check of one bundle; every step adds what it finds.
class Verification {
  public:
    Verification(std::string_view file, const BundleTrust& trust)
        : m_layout(bundle::split(file)), m_trust(trust) {}

    BundleReport run() && {
        for (const bundle::Misfit& misfit : m_layout.misfits)
            find({{}, "line " + std::to_string(misfit.line), misfit.cause});
        read_head();
        read_leaves();
        match_records();
        if (m_report.head) hold_to_head();
        if (m_trust.retained) hold_to_retained();
        m_report.records = m_layout.records.size();
        return std::move(m_report);
    }

  private:
    void find(AuditFinding finding) {
        if (m_report.findings.size() < most_findings)
            m_report.findings.push_back(std::move(finding));
        else
            ++m_report.unlisted;
    }
    void find_in(std::uint64_t seq, std::string cause) {
        find({seq, "record " + std::to_string(seq), std::move(cause)});
    }
    void find_head(std::string cause) { find({{}, "head", std::move(cause)}); }

    void read_head() {
        std::string_view line = m_layout.head;
        if (line.empty()) return;  // a misfit already
        if (!line.ends_with(',')) return find_head("should end with a comma");
        line.remove_suffix(1);
        auto head = parse_signed_head(line);
        if (!head) return find_head(head.error().text());
        m_report.head = *std::move(head);
        if (!m_trust.log(head_bytes(m_report.head->head), m_report.head->signature))
            find_head("is not signed by the key of the log");
    }

    void read_leaves() {
        for (std::size_t k = 0; k < m_layout.leaves.size(); ++k) {
            const auto item = list_item(m_layout.leaves, k);
            const bool quoted = item && item->size() == 66 && item->front() == '"' && item->back() == '"';
            const auto leaf = quoted ? parse_hash(item->substr(1, 64)) : std::nullopt;
            if (leaf)
                m_place_of.emplace(*leaf, k);
            else
                find_in(k, "its leaf cannot be read");
            m_leaves.push_back(leaf.value_or(Hash{}));
            m_all_leaves = m_all_leaves && leaf;
        }
    }

    /// Finds each record's leaf. A record may be gone or moved, so a line is no record's name: its leaf is.
    void match_records() {
        std::vector<bool> found(m_leaves.size(), false);
        for (std::size_t k = 0; k < m_layout.records.size(); ++k) {
            const auto item = list_item(m_layout.records, k);
            const auto place = item ? m_place_of.find(leaf_hash(*item)) : m_place_of.end();
            if (place == m_place_of.end()) {
                find({{}, "line " + std::to_string(k + 1) + " of the records", "is no record of this log"});
                continue;
            }
            found[place->second] = true;
            if (place->second == k)
                check_record(k, *item);
            else
                find_in(place->second, "stands at the place of record " + std::to_string(k));
        }
        for (std::size_t k = 0; k < found.size(); ++k)
            if (!found[k]) find_in(k, "is missing, or is not what the log holds");
    }

    /// A record that is the one of its leaf: is it what a log may hold there?
    void check_record(std::uint64_t seq, std::string_view bytes) {
        const auto record = parse_record(bytes);
        if (!record) return find_in(seq, record.error().text());
        if (record->seq != seq) find_in(seq, "says that it is record " + std::to_string(record->seq));
        if (record->prev != (seq == 0 ? Hash{} : m_leaves[seq - 1]))
            find_in(seq, "does not follow the one before it");
        if (m_report.head && record->statement.site != m_report.head->head.site)
            find_in(seq, "is of another site, " + on_one_line(record->statement.site));
        if (m_trust.statements && record->signature &&
            !m_trust.statements(statement_bytes(record->statement), *record->signature))
            find_in(seq, "its signature is not good");
        if (m_trust.evidence && record->statement.kind == "evidence.added" && !m_trust.evidence(record->statement))
            find_in(seq, "its evidence is not signed by the machine that it names");
    }

    void hold_to_head() {
        const TreeHead& head = m_report.head->head;
        if (head.size > m_leaves.size())
            find_in(m_leaves.size(),
                    "is missing: the head speaks of " + std::to_string(head.size) + " records");
        else if (head.size < m_leaves.size())
            find_in(head.size, "is more than the head speaks of");
        else if (m_all_leaves && root_of(m_leaves) != head.root)
            find_head("its root is not that of the leaves");
    }

    /// A retained head finds what a good signature cannot: an old copy, and another history.
    void hold_to_retained() {
        const SignedTreeHead& retained = *m_trust.retained;
        if (!m_trust.log(head_bytes(retained.head), retained.signature))
            return find({{}, "retained head", "is not signed by the key of the log"});
        if (m_report.head && m_report.head->head.site != retained.head.site)
            find_head("is of another site than the retained head");
        if (retained.head.size > m_leaves.size())
            return find_in(m_leaves.size(), "is missing: the retained head of " + retained.head.at + " had " +
                                                std::to_string(retained.head.size) +
                                                " records, so this is an older copy");
        const auto end = m_leaves.begin() + static_cast<std::ptrdiff_t>(retained.head.size);
        if (m_all_leaves && root_of({m_leaves.begin(), end}) != retained.head.root)
            find_head("the records before " + std::to_string(retained.head.size) +
                      " are not those of the retained head: history was rewritten");
    }

    bundle::Layout m_layout;
    const BundleTrust& m_trust;
    BundleReport m_report;
    std::vector<Hash> m_leaves;
    std::map<Hash, std::size_t> m_place_of;
    bool m_all_leaves = true;
};

}  // namespace

BundleReport verify_bundle(std::string_view file, const BundleTrust& trust) {
    return Verification(file, trust).run();
}

}  // namespace weave::loomlink
