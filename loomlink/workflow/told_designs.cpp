#include <loomlink/store/writer.hpp>
#include <loomlink/workflow/evidence.hpp>
#include <loomlink/workflow/told.hpp>
#include <stdexcept>

namespace weave::loomlink {

namespace {

std::string name_of(const std::string& design, std::int64_t number) {
    return "revision " + std::to_string(number) + " of " + design;
}

std::string of_record(const char* what, Seq seq) {
    return std::string(what) + " of record " + std::to_string(seq);
}

Hash hash_in(const Telling& told, const char* member) {
    return parse_hash(told.text(member)).value();
}

/// What the record of a saved revision tells of it.
Revision revision_of(const Telling& told) {
    Revision revision;
    revision.at = told.record.statement.at;
    revision.message = told.text("message");
    revision.document = hash_in(told, "document_sha256");
    revision.design_sha256 = hash_in(told, "design_sha256");
    revision.scene_sha256 = hash_in(told, "scene_sha256");
    revision.card_sha256 = hash_in(told, "card_sha256");
    revision.picks = told.number("picks");
    revision.ends = told.number("ends");
    return revision;
}

}  // namespace

void ToldDesigns::added(const Telling& told) {
    m_designs[told.subject()];
    m_things.push_back(kept_thing("design " + told.subject(), {told.seq()}));
}

/// Who worked on what nobody has approved yet is an author of what is built on it.
void ToldDesigns::inherit(ToldRevision& revision, const Telling& told) const {
    for (const Json& parent : told.data("parents")) {
        const ToldRevision& one = m_designs.at(told.subject()).at(parent.get<std::size_t>() - 1);
        if (!one.was_approved) revision.authors.insert(one.authors.begin(), one.authors.end());
    }
}

void ToldDesigns::saved(const Telling& told) {
    auto& revisions = m_designs.at(told.subject());
    std::vector<Hash> parents;
    for (const Json& parent : told.data("parents"))
        parents.push_back(revisions.at(parent.get<std::size_t>() - 1).hash);
    const Revision row = revision_of(told);
    ToldRevision made;
    made.hash = revision_hash(row, told.subject(), told.actor(), parents);
    made.authors.insert(told.actor());
    inherit(made, told);
    revisions.push_back(made);
    const auto number = static_cast<std::int64_t>(revisions.size());
    const std::string name = name_of(told.subject(), number);
    m_things.push_back(kept_thing(
        name, {hash_hex(made.hash), told.actor(), row.at, row.message, hash_hex(row.document),
               hash_hex(row.design_sha256), hash_hex(row.scene_sha256), hash_hex(row.card_sha256), row.picks,
               row.ends, told.seq()}));
    for (const std::string& author : made.authors)
        m_things.push_back(kept_thing(author + ", author of " + name, {1}));
    came_to(told.subject(), number, RevisionState::draft, told.seq());
    m_branches[{told.subject(), told.text("branch")}] = {number, told.seq()};
}

ToldDesigns::ToldRevision& ToldDesigns::bound(const Telling& told) {
    ToldRevision& revision =
        m_designs.at(told.subject()).at(static_cast<std::size_t>(told.number("revision")) - 1);
    if (told.text("sha256") != hash_hex(revision.hash))
        throw std::runtime_error("speaks of another revision than that of its number");
    return revision;
}

void ToldDesigns::submitted(const Telling& told) {
    bound(told);
    came_to(told.subject(), told.number("revision"), RevisionState::submitted, told.seq());
}

void ToldDesigns::decide(const Telling& told, DecisionKind kind) {
    m_things.push_back(kept_thing(of_record("decision", told.seq()),
                                  {told.number("revision"), told.subject(), told.actor(), word(kind)}));
}

void ToldDesigns::changes_requested(const Telling& told) {
    bound(told);
    decide(told, DecisionKind::request_changes);
    came_to(told.subject(), told.number("revision"), RevisionState::changes_requested, told.seq());
}

void ToldDesigns::approved(const Telling& told, std::size_t needed) {
    ToldRevision& revision = bound(told);
    decide(told, DecisionKind::approve);
    revision.approvals.insert(told.actor());
    if (revision.approvals.size() < needed) return;
    revision.was_approved = true;
    came_to(told.subject(), told.number("revision"), RevisionState::approved, told.seq());
}

void ToldDesigns::waived(const Telling& told) {
    bound(told);
    m_things.push_back(kept_thing(
        of_record("waiver", told.seq()),
        {told.number("revision"), told.subject(), told.actor(), told.text("rule"), told.reason()}));
}

void ToldDesigns::commented(const Telling& told) {
    bound(told);
    m_things.push_back(kept_thing(of_record("comment", told.seq()),
                                  {told.number("revision"), told.subject(), told.actor(), told.reason()}));
}

void ToldDesigns::evidence_added(const Telling& told) {
    const Evidence row =
        evidence_row(wire::read_simulation(told.data("statement")).value(), told.text("key"), told.seq());
    m_things.push_back(kept_thing(
        of_record("evidence", told.seq()),
        {hash_hex(row.design_sha256), hash_hex(row.scene_sha256), row.coverage, row.fidelity, row.parameters,
         row.solver, row.residual ? Json(*row.residual) : Json(nullptr), row.converged ? 1 : 0,
         hash_hex(row.report), row.signer}));
}

void ToldDesigns::came_to(const std::string& design, std::int64_t number, RevisionState state, Seq seq) {
    m_designs.at(design).at(static_cast<std::size_t>(number) - 1).state = state;
    m_things.push_back(kept_thing(by_record("state of " + name_of(design, number), seq), {word(state)}));
}

RevisionState ToldDesigns::state_of(const std::string& design, std::int64_t number) const {
    return m_designs.at(design).at(static_cast<std::size_t>(number) - 1).state;
}

void ToldDesigns::add_to(std::vector<KeptThing>& things) const {
    things.insert(things.end(), m_things.begin(), m_things.end());
    for (const auto& [name, head] : m_branches)
        things.push_back(
            kept_thing("branch " + name.second + " of " + name.first, {head.first, head.second}));
}

}  // namespace weave::loomlink
