#include <algorithm>
#include <loomlink/store/verify_steps.hpp>
#include <map>

namespace weave::loomlink {

namespace {

/// A row of the log's table.
struct EventRow {
    Seq seq;
    std::string record;
    Hash leaf;
    std::string kind;
    std::string actor;
    std::optional<std::string> subject;
};

EventRow event_row(const sql::Row& row) {
    return {static_cast<Seq>(row.integer(0)),
            row.bytes(1),
            row.fixed<Hash>(2),
            row.bytes(3),
            row.bytes(4),
            row.is_null(5) ? std::nullopt : std::optional(row.bytes(5))};
}

/// The leaves by their number, recomputed from the records, up to the first that is missing.
struct Leaves {
    std::vector<Hash> hashes;
    bool whole = true;
};

void inspect_record(Inspection& inspection, const EventRow& row, const Hash& prev, const std::string& site) {
    const auto record = parse_record(row.record);
    if (leaf_hash(row.record) != row.leaf) inspection.find_in(row.seq, "is not what its leaf says");
    if (!record) return inspection.find_in(row.seq, record.error().text());
    const Statement& statement = record->statement;
    if (record->seq != row.seq)
        inspection.find_in(row.seq, "says that it is record " + std::to_string(record->seq));
    if (record->prev != prev) inspection.find_in(row.seq, "does not follow the one before it");
    if (statement.site != site) inspection.find_in(row.seq, "is of another site");
    if (statement.kind != row.kind || statement.actor != row.actor || statement.subject != row.subject)
        inspection.find_in(row.seq, "is filed as something else than it says");
    if (inspection.trust.statements && record->signature &&
        !inspection.trust.statements(statement_bytes(statement), *record->signature))
        inspection.find_in(row.seq, "its signature is not good");
}

Result<Leaves> inspect_records(Inspection& inspection, const std::string& site) {
    Leaves leaves;
    Hash prev{};
    const auto look = [&](const sql::Row& sql_row) {
        const EventRow row = event_row(sql_row);
        if (leaves.whole && row.seq != leaves.hashes.size()) {
            inspection.find_in(leaves.hashes.size(), "is missing");
            leaves.whole = false;
        }
        if (!leaves.whole) return;
        inspect_record(inspection, row, prev, site);
        prev = leaf_hash(row.record);
        leaves.hashes.push_back(prev);
    };
    WEAVE_CHECK_OK(inspection.connection.each(
        "SELECT seq, record, leaf, kind, actor, subject FROM event ORDER BY seq", look));
    return leaves;
}

/// The records that lie below a node.
std::string below(NodePlace place) {
    const std::uint64_t first = place.index << place.level;
    const std::uint64_t last = first + (std::uint64_t{1} << place.level) - 1;
    return "tree above records " + std::to_string(first) + " to " + std::to_string(last);
}

Status inspect_tree(Inspection& inspection, const Leaves& leaves) {
    std::map<NodePlace, Hash> expected;
    const NodeReader node = [&](NodePlace place) -> Result<Hash> { return expected.at(place); };
    for (std::uint64_t size = 0; size < leaves.hashes.size(); ++size) {
        WEAVE_TRY(const auto complete, append_leaf(size, leaves.hashes[size], node));
        for (const auto& [place, hash] : complete) expected[place] = hash;
    }
    WEAVE_CHECK_OK(inspection.connection.each(
        "SELECT level, position, hash FROM tree_node ORDER BY position << CAST(level AS INTEGER), level",
        [&](const sql::Row& row) {
            const NodePlace place{static_cast<unsigned>(row.integer(0) & 63),
                                  static_cast<std::uint64_t>(row.integer(1))};
            const auto known = expected.find(place);
            if (known == expected.end())
                inspection.find_in(leaves.hashes.size(), "is missing: the tree reaches beyond it");
            else if (known->second != row.fixed<Hash>(2))
                inspection.find(below(place), "is not made of these records");
            if (known != expected.end()) expected.erase(known);
        }));
    for (const auto& [place, hash] : expected)
        if (place.level > 0) inspection.find(below(place), "is missing");
    return {};
}

void inspect_head(Inspection& inspection, const std::string& name, const SignedTreeHead& head,
                  const std::string& site, const Leaves& leaves) {
    if (head.head.site != site) inspection.find(name, "is of another site");
    if (inspection.trust.log && !inspection.trust.log(head_bytes(head.head), head.signature))
        inspection.find(name, "is not signed by the key of the log");
    if (head.head.size > leaves.hashes.size())
        return inspection.find_in(leaves.hashes.size(), "is missing: the " + name + " speaks of " +
                                                            std::to_string(head.head.size) + " records");
    const auto end = leaves.hashes.begin() + static_cast<std::ptrdiff_t>(head.head.size);
    if (root_of({leaves.hashes.begin(), end}) != head.head.root)
        inspection.find(name, "the records before " + std::to_string(head.head.size) +
                                  " are not those that it speaks of");
}

Status inspect_heads(Inspection& inspection, const std::string& site, const Leaves& leaves) {
    WEAVE_TRY(const auto heads,
              inspection.connection.all("SELECT id, head, last_event FROM tree_head ORDER BY id",
                                        [](const sql::Row& row) {
                                            return std::tuple(row.integer(0), row.bytes(1), row.integer(2));
                                        }));
    WEAVE_TRY(const std::int64_t shown,
              inspection.connection.number(
                  "SELECT count(*) FROM event WHERE kind IN ('release.pulled', 'log.exported')"));
    if (heads.empty() && shown > 0)
        inspection.find("heads", "are missing, though looms or engineers were given some");
    for (const auto& [id, bytes, last] : heads) {
        const std::string name = "head " + std::to_string(id);
        const auto head = parse_signed_head(bytes);
        if (!head) {
            inspection.find(name, head.error().text());
            continue;
        }
        if (head->head.size != static_cast<std::uint64_t>(last) + 1)
            inspection.find(name, "is filed at another record");
        inspect_head(inspection, name, *head, site, leaves);
    }
    if (inspection.trust.retained)
        inspect_head(inspection, "retained head", *inspection.trust.retained, site, leaves);
    return {};
}

}  // namespace

Status inspect_log(Inspection& inspection) {
    WEAVE_TRY(const std::string site, Reader(inspection.connection).site());
    WEAVE_TRY(const Leaves leaves, inspect_records(inspection, site));
    if (!leaves.whole) return {};  // without the missing record no root can be made again
    WEAVE_CHECK_OK(inspect_tree(inspection, leaves));
    return inspect_heads(inspection, site, leaves);
}

}  // namespace weave::loomlink
