#include <loomlink/workflow/steps.hpp>

#include <weave/keys/codes.hpp>

#include <algorithm>
#include <loomlink/workflow/missing.hpp>
#include <loomlink/workflow/names.hpp>
#include <loomlink/workflow/release_files.hpp>

namespace weave::loomlink {

namespace {

/// What a statement binds of a revision.
Json bound(const FoundRevision& found) {
    return {{"revision", found.revision.number}, {"sha256", hash_hex(found.revision.hash)}};
}

Deed deed_of(const char* kind, const StepWish& wish, bool is_signed) {
    Deed deed{kind, wish.design, wish.reason, {{"revision", wish.number}}};
    deed.is_signed = is_signed;
    return deed;
}

Json state_answer(RevisionState state) {
    return {{"state", word(state)}};
}

Desk::Check check_action(const StepWish& wish, Action action) {
    return [&wish, action](const Reader& reader, const Caller& now) -> Status {
        WEAVE_TRY(const FoundRevision found, find_revision(reader, now, wish.design, wish.number));
        return may(now, action, found.revision);
    };
}

Status check_reason(const StepWish& wish) {
    return check_text(wish.reason, "reason");
}

Status check_undecided(const Reader& reader, const Caller& caller, Id revision) {
    WEAVE_TRY(const auto decisions, reader.decisions(revision));
    for (const Decision& decision : decisions)
        if (decision.person == caller.id) return deny(Denial::conflict, "you have decided on it already");
    return {};
}

std::string in_one(const std::vector<std::string>& texts) {
    std::string all;
    for (const std::string& text : texts) all += (all.empty() ? "" : "; ") + text;
    return all;
}

}  // namespace

Status log_validation(Writer& writer, const Desk& desk, const std::string& request,
                      const FoundRevision& found, const Validation& validation) {
    const Deed deed{"revision.validated", found.design.name, {}, to_data(validation, found.revision)};
    const auto logged = writer.append(desk.statement_of("loomlink", request, deed));
    return logged ? Status() : Status(logged.error());
}

/// The revision, once it is known that the caller may do this.
Result<FoundRevision> Steps::found(const Caller& caller, Action action, const StepWish& wish) {
    return m_desk->store().read([&](const Reader& reader) -> Result<FoundRevision> {
        WEAVE_TRY(const Caller now, fresh_caller(reader, caller));
        WEAVE_TRY(FoundRevision one, find_revision(reader, now, wish.design, wish.number));
        WEAVE_CHECK_OK(may(now, action, one.revision));
        return one;
    });
}

Result<std::vector<Validation>> Steps::validate_for(const FoundRevision& here,
                                                    const std::vector<std::string>& looms) {
    return m_desk->store().read([&](const Reader& reader) -> Result<std::vector<Validation>> {
        WEAVE_TRY(const RevisionClothPtr cloth, m_shelf->find(reader, here.revision.document));
        WEAVE_TRY(const auto known, reader.looms());
        for (const std::string& name : looms)
            if (std::none_of(known.begin(), known.end(), [&](const Loom& loom) { return loom.name == name; }))
                return deny(Denial::absent, "there is no loom of the name '" + name + "'");
        std::vector<Validation> list;
        for (const Loom& loom : known) {
            if (!looms.empty() && std::find(looms.begin(), looms.end(), loom.name) == looms.end()) continue;
            WEAVE_TRY(const ProfileInForce profile, profile_in_force(reader, loom.id));
            list.push_back(validate(*cloth, loom.name, profile, straight_map(cloth->design),
                                    release_stem(here.design.name, here.revision.number)));
        }
        return list;
    });
}

/// Holds it to the profiles in force again, where they changed since.
Status Steps::renew_validations(const FoundRevision& here) {
    WEAVE_TRY(const auto stale,
              m_desk->store().read([&](const Reader& reader) -> Result<std::vector<std::string>> {
                  std::vector<std::string> looms;
                  WEAVE_TRY(const auto known, validations_of(reader, here.design, here.revision));
                  for (const Validation& one : known) {
                      WEAVE_TRY(const std::string why, why_stale(reader, one));
                      if (!why.empty()) looms.push_back(one.loom);
                  }
                  return looms;
              }));
    if (stale.empty()) return {};
    WEAVE_TRY(const auto fresh, validate_for(here, stale));
    return m_desk->store().write([&](Writer& writer) -> Status {
        for (const Validation& validation : fresh)
            WEAVE_CHECK_OK(log_validation(writer, *m_desk, make_token(), here, validation));
        return {};
    });
}

Result<Json> Steps::submit(const Caller& caller, const Ask& ask, const StepWish& wish,
                           const std::vector<std::string>& looms) {
    Deed deed = deed_of("revision.submitted", wish, true);
    deed.data["looms"] = looms;
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const FoundRevision here, found(caller, Action::submit, wish));
        WEAVE_CHECK_OK(check_reason(wish));
        WEAVE_TRY(const auto validations, validate_for(here, looms));
        deed.data = bound(here);
        return m_desk->commit(
            caller, ask, deed, check_action(wish, Action::submit),
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(writer.set_state(here.revision.id, RevisionState::submitted, step.event));
                for (const Validation& validation : validations)
                    WEAVE_CHECK_OK(log_validation(writer, *m_desk, ask.request, here, validation));
                return state_answer(RevisionState::submitted);
            });
    });
}

Result<Json> Steps::comment(const Caller& caller, const Ask& ask, const StepWish& wish,
                            std::optional<std::int64_t> pick, std::optional<std::int64_t> end) {
    Deed deed = deed_of("revision.commented", wish, false);
    if (pick) deed.data["pick"] = *pick;
    if (end) deed.data["end"] = *end;
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const FoundRevision here, found(caller, Action::comment, wish));
        WEAVE_CHECK_OK(check_text(wish.reason, "text"));
        WEAVE_CHECK_OK(check_on_card(here.revision, pick, end));
        deed.data.update(bound(here));
        return m_desk->commit(
            caller, ask, deed, check_action(wish, Action::comment),
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(writer.add_comment({here.revision.id, caller.id, wish.reason, step.event}));
                return state_answer(here.revision.state);
            });
    });
}

Result<Json> Steps::request_changes(const Caller& caller, const Ask& ask, const StepWish& wish) {
    Deed deed = deed_of("revision.changes_requested", wish, true);
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const FoundRevision here, found(caller, Action::request_changes, wish));
        WEAVE_CHECK_OK(check_reason(wish));
        deed.data = bound(here);
        const auto check = [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(check_action(wish, Action::request_changes)(reader, now));
            return check_undecided(reader, now, here.revision.id);
        };
        return m_desk->commit(
            caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(writer.add_decision(
                    {here.revision.id, caller.id, DecisionKind::request_changes, step.event}));
                WEAVE_CHECK_OK(
                    writer.set_state(here.revision.id, RevisionState::changes_requested, step.event));
                return state_answer(RevisionState::changes_requested);
            });
    });
}

Result<Json> Steps::waive(const Caller& caller, const Ask& ask, const StepWish& wish, const std::string& rule,
                          const std::string& loom) {
    Deed deed = deed_of("revision.waived", wish, true);
    deed.data["rule"] = rule;
    deed.data["loom"] = loom;
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const FoundRevision here, found(caller, Action::waive, wish));
        WEAVE_CHECK_OK(check_reason(wish));
        if (std::none_of(rules().begin(), rules().end(), [&](const Rule& one) { return one.id == rule; }))
            return bad_input("is no rule of the validation", "rule");
        deed.data.update(bound(here));
        const auto check = [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(check_action(wish, Action::waive)(reader, now));
            WEAVE_TRY(const auto there, reader.loom(loom));
            return there ? Status() : Status(deny(Denial::absent, "there is no such loom"));
        };
        return m_desk->commit(
            caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(
                    writer.add_waiver({here.revision.id, rule, wish.reason, caller.id, step.event}));
                return state_answer(here.revision.state);
            });
    });
}

Result<Json> Steps::approve(const Caller& caller, const Ask& ask, const StepWish& wish) {
    Deed deed = deed_of("revision.approved", wish, true);
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const FoundRevision here, found(caller, Action::approve, wish));
        WEAVE_CHECK_OK(check_reason(wish));
        WEAVE_CHECK_OK(renew_validations(here));
        deed.data = bound(here);
        const auto check = [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(check_action(wish, Action::approve)(reader, now));
            WEAVE_CHECK_OK(check_undecided(reader, now, here.revision.id));
            WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
            WEAVE_TRY(const auto lacks, missing_evidence(reader, here.design, here.revision, policy));
            return lacks.empty() ? Status()
                                 : Status(deny(Denial::conflict, "still missing: " + in_one(lacks)));
        };
        return m_desk->commit(
            caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_CHECK_OK(
                    writer.add_decision({here.revision.id, caller.id, DecisionKind::approve, step.event}));
                WEAVE_TRY(const SitePolicy policy, policy_in_force(writer));
                WEAVE_TRY(const std::size_t approvals, approvals_of(writer, here.revision.id));
                if (approvals < policy.approvals)
                    return Json{{"state", word(RevisionState::submitted)},
                                {"approvals", approvals},
                                {"approvals_needed", policy.approvals}};
                WEAVE_CHECK_OK(writer.set_state(here.revision.id, RevisionState::approved, step.event));
                return state_answer(RevisionState::approved);
            });
    });
}

}  // namespace weave::loomlink
