#include <loomlink/workflow/waiting.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/workflow/looms.hpp>
#include <loomlink/workflow/releases.hpp>
#include <loomlink/workflow/rules.hpp>
#include <set>

namespace weave::loomlink {

namespace {

Result<std::string> design_name(const Reader& reader, Id id) {
    WEAVE_TRY(const auto designs, reader.designs());
    for (const Design& design : designs)
        if (design.id == id) return design.name;
    return std::string();
}

Status add_revisions(const Reader& reader, RevisionState state, const char* what,
                     const std::function<bool(const Revision&)>& concerns, Json& items) {
    WEAVE_TRY(const auto revisions, reader.revisions_in(state));
    for (const Revision& revision : revisions) {
        if (!concerns(revision)) continue;
        WEAVE_TRY(const auto steps, reader.revision_steps(revision.id));
        WEAVE_TRY(const EventRecord record, reader.record(steps.back().event));
        WEAVE_TRY(const std::string design, design_name(reader, revision.design));
        items.push_back({{"design", design},
                         {"revision", revision.number},
                         {"state", word(state)},
                         {"what", what},
                         {"since", record.statement.at}});
    }
    return {};
}

/// Releases of a loom that are in this state now (state_now()).
Status add_releases(const Reader& reader, const Loom& loom, const std::string& state, const char* what,
                    const std::function<Result<bool>(const Release&)>& concerns, Json& items) {
    WEAVE_TRY(const auto releases, reader.releases(loom.id));
    for (const Release& release : releases) {
        WEAVE_TRY(const std::string now, state_now(reader, release));
        if (now != state) continue;
        WEAVE_TRY(const bool waits, concerns(release));
        if (!waits) continue;
        WEAVE_TRY(const FoundRevision found, revision_of(reader, release));
        WEAVE_TRY(const LastStep step, last_step(reader, release));
        items.push_back({{"design", found.design.name},
                         {"revision", found.revision.number},
                         {"loom", loom.name},
                         {"release", release.number},
                         {"state", state},
                         {"what", what},
                         {"since", step.at}});
    }
    return {};
}

/// Releases of own revisions that are woven and with which somebody at a loom had trouble.
Status add_faults(const Reader& reader, const Caller& caller, Json& items) {
    WEAVE_TRY(const auto looms, reader.looms());
    for (const Loom& loom : looms) {
        WEAVE_TRY(const auto releases, reader.releases(loom.id));
        for (const Release& release : releases) {
            if (release.state != ReleaseStage::released) continue;
            WEAVE_TRY(const auto faults, reader.faults(release.id));
            WEAVE_TRY(const FoundRevision found, revision_of(reader, release));
            if (faults.empty() || !is_author(caller, found.revision)) continue;
            WEAVE_TRY(const EventRecord newest, reader.record(faults.back().event));
            items.push_back({{"design", found.design.name},
                             {"revision", found.revision.number},
                             {"loom", loom.name},
                             {"release", release.number},
                             {"state", release_word(release.state)},
                             {"what", counted(faults.size(), "fault") + " reported at the loom"},
                             {"since", newest.statement.at}});
        }
    }
    return {};
}

/// The heads of all branches: what is followed by another revision waits for nobody.
Result<std::set<Id>> heads_of_branches(const Reader& reader) {
    std::set<Id> heads;
    WEAVE_TRY(const auto designs, reader.designs());
    for (const Design& design : designs) {
        WEAVE_TRY(const auto branches, reader.branches(design.id));
        for (const Branch& branch : branches) heads.insert(branch.head);
    }
    return heads;
}

Status add_for_designer(const Reader& reader, const Caller& caller, Json& items) {
    WEAVE_TRY(const auto heads, heads_of_branches(reader));
    const auto mine = [&](const Revision& revision) {
        return revision.author == caller.id && heads.contains(revision.id);
    };
    WEAVE_CHECK_OK(
        add_revisions(reader, RevisionState::changes_requested, "changes were requested", mine, items));
    WEAVE_CHECK_OK(add_revisions(reader, RevisionState::draft, "a draft, not submitted yet", mine, items));
    return add_faults(reader, caller, items);
}

Status add_for_approver(const Reader& reader, const Caller& caller, Json& items) {
    const auto not_mine = [&](const Revision& revision) { return !is_author(caller, revision); };
    WEAVE_CHECK_OK(add_revisions(reader, RevisionState::submitted, "to approve, or to ask for changes",
                                 not_mine, items));
    WEAVE_CHECK_OK(add_revisions(
        reader, RevisionState::approved, "to release to a loom", [](const Revision&) { return true; },
        items));
    const auto unsigned_by_me = [&](const Release& release) -> Result<bool> {
        WEAVE_TRY(const auto keys, reader.keys(caller.id));
        return std::none_of(release.signatures.begin(), release.signatures.end(),
                            [&](const ReleaseSignature& one) {
                                return std::any_of(keys.begin(), keys.end(), [&](const PersonKey& key) {
                                    return key.id == one.key && !key.revoked;
                                });
                            });
    };
    WEAVE_TRY(const auto looms, reader.looms());
    for (const Loom& loom : looms)
        WEAVE_CHECK_OK(add_releases(reader, loom, "awaiting", "waits for your signature",
                                    unsigned_by_me, items));
    return {};
}

Status add_for_operator(const Reader& reader, const Caller& caller, Json& items) {
    const auto not_loaded = [&](const Release& release) -> Result<bool> {
        WEAVE_TRY(const auto loaded, reader.loaded(release.id));
        return loaded.empty();
    };
    WEAVE_TRY(const auto looms, reader.looms_of(caller.id));
    for (const Loom& loom : looms)
        WEAVE_CHECK_OK(add_releases(reader, loom, "released", "released, not loaded yet",
                                    not_loaded, items));
    return {};
}

}  // namespace

Result<Json> waiting_for(Desk& desk, const Caller& caller) {
    return desk.store().read([&](const Reader& reader) -> Result<Json> {
        Json items = Json::array();
        if (caller.is(PersonRole::designer)) WEAVE_CHECK_OK(add_for_designer(reader, caller, items));
        if (caller.is(PersonRole::approver)) WEAVE_CHECK_OK(add_for_approver(reader, caller, items));
        if (caller.is(PersonRole::operator_)) WEAVE_CHECK_OK(add_for_operator(reader, caller, items));
        return Json{{"items", std::move(items)}};
    });
}

}  // namespace weave::loomlink
