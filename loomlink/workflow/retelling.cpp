#include <loomlink/workflow/retelling.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <loomlink/store/store.hpp>
#include <loomlink/workflow/told.hpp>

namespace weave::loomlink {

namespace {

/// Kinds that tell of nothing that a table keeps.
const std::set<std::string>& kinds_without_rows() {
    static const std::set<std::string> kinds{
        "refused",         "log.viewed",         "log.exported",      "release.viewed", "release.pulled",
        "revision.viewed", "revision.validated", "revision.exported", "revision.pulled", "access.given"};
    return kinds;
}

/// Steps that a person signs (workflow/README.md, "What signing means").
bool is_signed_step(const std::string& kind) {
    static const std::set<std::string> kinds{
        "revision.submitted", "revision.changes_requested", "revision.waived",   "revision.approved",
        "release.made",       "release.signed",             "release.withdrawn", "trust.published"};
    return kinds.contains(kind);
}

class Retelling {
  public:
    void tell(Seq seq, std::string_view bytes) {
        const auto record = parse_record(bytes);
        if (!record) return;  // what is no record is verify_store()'s to tell
        try {
            check_signature(*record);
            tell(Telling{*record});
        } catch (const std::exception& trouble) {
            find(seq, "does not tell what its kind has to: " + std::string(trouble.what()));
        }
    }

    [[nodiscard]] std::vector<KeptThing> things() const {
        std::vector<KeptThing> all;
        m_people.add_to(all);
        m_designs.add_to(all);
        m_looms.add_to(all);
        std::sort(all.begin(), all.end());
        return all;
    }
    [[nodiscard]] const std::vector<AuditFinding>& findings() const { return m_findings; }

  private:
    using Teller = std::function<void(Retelling&, const Telling&)>;

    void find(Seq seq, std::string cause) {
        m_findings.push_back({seq, "record " + std::to_string(seq), std::move(cause)});
    }

    void check_signature(const EventRecord& record) {
        const Statement& statement = record.statement;
        if (is_signed_step(statement.kind) && !record.signature) find(record.seq, "is not signed");
        if (record.signature && !m_people.holds(statement.actor, record.signature->key))
            find(record.seq, "is signed by a key that was not, or no longer, that of " + statement.actor);
    }

    void tell(const Telling& told) {
        const std::string& kind = told.record.statement.kind;
        const auto teller = tellers().find(kind);
        if (teller != tellers().end())
            teller->second(*this, told);
        else if (!kinds_without_rows().contains(kind))
            find(told.seq(), "is of a kind that this program does not know: " + kind);
    }

    static const std::map<std::string, Teller>& tellers();

    ToldPeople m_people;
    ToldDesigns m_designs;
    ToldLooms m_looms{m_designs};
    std::vector<AuditFinding> m_findings;
};

const std::map<std::string, Retelling::Teller>& Retelling::tellers() {
    const auto people = [](auto member) {
        return [member](Retelling& all, const Telling& told) { (all.m_people.*member)(told); };
    };
    const auto designs = [](auto member) {
        return [member](Retelling& all, const Telling& told) { (all.m_designs.*member)(told); };
    };
    const auto looms = [](auto member) {
        return [member](Retelling& all, const Telling& told) { (all.m_looms.*member)(told); };
    };
    static const std::map<std::string, Teller> tellers{
        {"person.invited", people(&ToldPeople::invited)},
        {"person.joined", people(&ToldPeople::joined)},
        {"person.password_changed", people(&ToldPeople::password_changed)},
        {"person.password_rehashed", people(&ToldPeople::password_rehashed)},
        {"person.reset", people(&ToldPeople::reset)},
        {"person.roles_set", people(&ToldPeople::roles_set)},
        {"person.enabled", [](Retelling& all, const Telling& told) { all.m_people.set_active(told, true); }},
        {"person.disabled",
         [](Retelling& all, const Telling& told) { all.m_people.set_active(told, false); }},
        {"signer.invited", people(&ToldPeople::signer_invited)},
        {"signer.enrolled", people(&ToldPeople::signer_enrolled)},
        {"signer.revoked", people(&ToldPeople::signer_revoked)},
        {"person.signed_in", people(&ToldPeople::signed_in)},
        {"person.signed_out", people(&ToldPeople::signed_out)},
        {"policy.set", people(&ToldPeople::policy_set)},
        {"trust.published", people(&ToldPeople::trust_published)},
        {"design.added", designs(&ToldDesigns::added)},
        {"revision.saved", designs(&ToldDesigns::saved)},
        {"revision.submitted", designs(&ToldDesigns::submitted)},
        {"revision.changes_requested", designs(&ToldDesigns::changes_requested)},
        {"revision.approved",
         [](Retelling& all, const Telling& told) {
             all.m_designs.approved(told, all.m_people.approvals_needed());
         }},
        {"revision.waived", designs(&ToldDesigns::waived)},
        {"revision.commented", designs(&ToldDesigns::commented)},
        {"evidence.added", designs(&ToldDesigns::evidence_added)},
        {"loom.added", looms(&ToldLooms::added)},
        {"loom.profile_set", looms(&ToldLooms::profile_set)},
        {"loom.operators_set", looms(&ToldLooms::operators_set)},
        {"loom.place_kept", looms(&ToldLooms::place_kept)},
        {"loom.loaded", looms(&ToldLooms::loaded)},
        {"loom.fault_reported", looms(&ToldLooms::fault_reported)},
        {"release.made", looms(&ToldLooms::release_made)},
        {"release.signed", looms(&ToldLooms::release_signed)},
        {"release.in_force", looms(&ToldLooms::release_in_force)},
        {"release.withdrawn", looms(&ToldLooms::release_withdrawn)},
    };
    return tellers;
}

std::string shortened(const std::string& text) {
    constexpr std::size_t most = 300;
    return text.size() <= most ? text : text.substr(0, most) + "…";
}

/// What is in one list and not in the other, each as often as it is; both sorted.
std::vector<KeptThing> without(const std::vector<KeptThing>& list, const std::vector<KeptThing>& other) {
    std::vector<KeptThing> rest;
    std::set_difference(list.begin(), list.end(), other.begin(), other.end(), std::back_inserter(rest));
    return rest;
}

void compare(const std::vector<KeptThing>& kept, const std::vector<KeptThing>& told,
             std::vector<AuditFinding>& findings) {
    const auto more = without(kept, told), missing = without(told, kept);
    const auto find_place = [](const std::vector<KeptThing>& list, const std::string& place) {
        return std::find_if(list.begin(), list.end(), [&](const KeptThing& one) { return one.place == place; });
    };
    for (const KeptThing& one : more) {
        const auto should = find_place(missing, one.place);
        findings.push_back(
            {{},
             one.place,
             should == missing.end()
                 ? "no record of the log tells of it: " + shortened(one.values)
                 : "is " + shortened(one.values) + ", but the log tells " + shortened(should->values)});
    }
    const auto may_end = [](const KeptThing& one) { return one.place.starts_with("session "); };  // by time
    for (const KeptThing& one : missing)
        if (!may_end(one) && find_place(more, one.place) == more.end())
            findings.push_back({{}, one.place, "is missing; the log tells " + shortened(one.values)});
}

Status tell_all(const Reader& reader, Retelling& retelling) {
    constexpr std::size_t page = 1000;
    EventFilter filter{0, page, {}, {}};
    while (true) {
        WEAVE_TRY(const auto events, reader.events(filter));
        for (const auto& [seq, bytes] : events) retelling.tell(seq, bytes);
        if (events.size() < page) return {};
        filter.from = events.back().first + 1;
    }
}

}  // namespace

Result<std::vector<AuditFinding>> verify_tables(const std::string& store) {
    std::vector<AuditFinding> findings;
    const Status asked = look_into(store, [&](const Reader& reader) -> Status {
        Retelling retelling;
        WEAVE_CHECK_OK(tell_all(reader, retelling));
        WEAVE_TRY(const auto kept, reader.kept());
        findings = retelling.findings();
        compare(kept, retelling.things(), findings);
        return {};
    });
    if (!asked) return asked.error();
    return findings;
}

}  // namespace weave::loomlink
