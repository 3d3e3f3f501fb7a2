#include <loomlink/workflow/releases.hpp>

#include <algorithm>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/looms.hpp>
#include <loomlink/workflow/evidence.hpp>
#include <loomlink/workflow/names.hpp>
#include <loomlink/workflow/policy.hpp>
#include <loomlink/workflow/release_files.hpp>
#include <loomlink/workflow/rules.hpp>
#include <loomlink/workflow/steps.hpp>
#include <set>

namespace weave::loomlink {

namespace {

/// Refused unless the caller's key counts for releases: a terminal would not take them.
Status check_releaser(const Reader& reader, const Caller& caller) {
    WEAVE_TRY(const auto trust, newest_trust(reader));
    WEAVE_TRY(const PersonKey key, signing_key(reader, caller.id));
    const TrustedKey* listed = trust ? trust->find(key.id) : nullptr;
    if (listed != nullptr && listed->has(Role::release)) return {};
    return deny(Denial::conflict,
                "no trust document lists your key for releases yet: an administrator has to "
                "sign one");
}

/// Releases of a design that a loom has now, or is about to have.
Result<std::vector<Release>> live_releases(const Reader& reader, Id loom, Id design) {
    WEAVE_TRY(auto releases, reader.releases(loom));
    std::vector<Release> live;
    for (Release& release : releases) {
        if (release.state != ReleaseStage::released && release.state != ReleaseStage::prepared) continue;
        WEAVE_TRY(const auto revision, reader.revision(release.revision));
        if (revision && revision->design == design) live.push_back(std::move(release));
    }
    return live;
}

Status check_superseded(const Reader& reader, Id loom, Id design, const ReleaseWish& wish) {
    WEAVE_TRY(const auto live, live_releases(reader, loom, design));
    std::optional<std::int64_t> now;
    for (const Release& release : live) {
        if (release.state == ReleaseStage::prepared)
            return deny(Denial::conflict, "release " + std::to_string(release.number) +
                                              " of this design waits for signatures: withdraw it first");
        now = release.number;
    }
    if (now == wish.supersedes) return {};
    if (!now) return deny(Denial::conflict, "the loom has no release of this design to supersede");
    return deny(Denial::conflict, "the loom has release " + std::to_string(*now) +
                                      " of this design: say that the new one supersedes it (supersedes " +
                                      std::to_string(*now) + ")");
}

/// The design whose history tells what becomes of a release; empty where the caller has no such release, as is then refused.
std::string design_of(const Reader& reader, const Caller& caller, const std::string& loom, std::int64_t number) {
    const auto found = find_release(reader, caller, loom, number);
    if (!found) return {};
    const auto revision = revision_of(reader, found->release);
    return revision ? revision->design.name : std::string();
}

/// Whether a revision has files on any loom, or is about to.
Result<bool> is_on_a_loom(const Reader& reader, Id revision) {
    WEAVE_TRY(const auto releases, reader.releases_of(revision));
    return std::any_of(releases.begin(), releases.end(), [](const Release& release) {
        return release.state == ReleaseStage::released || release.state == ReleaseStage::prepared;
    });
}

/// A revision that no loom has any more comes to `state`.
Status leave_looms(Writer& writer, Id revision, RevisionState state, Seq event) {
    WEAVE_TRY(const bool stays, is_on_a_loom(writer, revision));
    WEAVE_TRY(const auto now, writer.revision(revision));
    if (stays || !now || now->state != RevisionState::released) return {};
    return writer.set_state(revision, state, event);
}

/// Everything that follows once enough people have signed.
Status put_in_force(Writer& writer, Id id, Seq event) {
    WEAVE_TRY(const auto release, writer.release(id));
    WEAVE_TRY(const auto revision, writer.revision(release->revision));
    WEAVE_TRY(const auto live, live_releases(writer, release->loom, revision->design));
    WEAVE_CHECK_OK(writer.set_release_state(id, ReleaseStage::released, event));
    if (revision->state == RevisionState::approved)
        WEAVE_CHECK_OK(writer.set_state(revision->id, RevisionState::released, event));
    for (const Release& before : live) {
        if (before.id == id || before.state != ReleaseStage::released) continue;
        WEAVE_CHECK_OK(writer.set_release_state(before.id, ReleaseStage::superseded, event));
        WEAVE_CHECK_OK(leave_looms(writer, before.revision, RevisionState::superseded, event));
    }
    return {};
}

/// What the log says where a signature was the last one that was needed: its own record, since a release
/// comes to its next state by a record after the one that made it.
Deed in_force(const std::string& design, const std::string& reason, const std::string& loom,
              std::int64_t number) {
    return {"release.in_force", design, reason, {{"loom", loom}, {"release", number}}};
}

/// What follows from a signature: with enough of them the release is in force, by this statement.
Result<Json> signed_answer(Writer& writer, Id id, const Statement& in_force) {
    WEAVE_TRY(auto release, writer.release(id));
    WEAVE_TRY(const SignedManifest manifest, signed_manifest(writer, *release));
    if (release->state == ReleaseStage::prepared && manifest.people >= manifest.needed) {
        WEAVE_TRY(const Seq event, writer.append(in_force));
        WEAVE_CHECK_OK(put_in_force(writer, id, event));
        WEAVE_TRY(release, writer.release(id));
    }
    return Json{{"loom", in_force.data.at("loom")},
                {"number", release->number},
                {"state", release_word(release->state)}};
}

/// What a release is made from, as the store has it now.
struct ReleaseParts {
    FoundRevision found;
    Loom loom;
    ProfileInForce profile;
    RevisionClothPtr cloth;
    std::uint64_t number = 0;
};

Result<ReleaseParts> parts_of(const Reader& reader, const Caller& caller, ClothShelf& shelf,
                              const ReleaseWish& wish) {
    WEAVE_TRY(const Caller now, fresh_caller(reader, caller));
    ReleaseParts parts;
    WEAVE_TRY(parts.found, find_revision(reader, now, wish.design, wish.revision));
    WEAVE_CHECK_OK(may(now, Action::release, parts.found.revision));
    WEAVE_CHECK_OK(check_releaser(reader, now));
    WEAVE_TRY(parts.loom, find_loom(reader, now, wish.loom));
    WEAVE_CHECK_OK(check_superseded(reader, parts.loom.id, parts.found.design.id, wish));
    WEAVE_TRY(parts.profile, profile_in_force(reader, parts.loom.id));
    WEAVE_TRY(const auto releases, reader.releases(parts.loom.id));
    parts.number = releases.empty() ? 1 : static_cast<std::uint64_t>(releases.front().number) + 1;
    WEAVE_TRY(parts.cloth, shelf.find(reader, parts.found.revision.document));
    return parts;
}

/// Evidence as it is now: nothing that was revoked or broken since the approval goes to a loom.
Status check_evidence(const Reader& reader, const ReleaseParts& parts, const Validation& validation) {
    WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
    WEAVE_TRY(const auto simulations, simulations_of(reader, parts.found.revision));
    auto missing = missing_simulation(simulations, parts.found.revision, policy);
    WEAVE_TRY(const auto waived, waivers_with_looms(reader, parts.found.revision.id));
    for (std::string& text : open_errors(validation, waived)) missing.push_back(std::move(text));
    if (missing.empty()) return {};
    std::string all;
    for (const std::string& text : missing) all += (all.empty() ? "" : "; ") + text;
    return invalid("it cannot go on the loom: " + all);
}

/// The SHA-256 of each file by its name.
Json files_json(const ReleasePackage& package) {
    Json files = Json::object();
    for (const PackageFile& file : package.files) files[file.path] = hash_hex(sha256(file.bytes));
    return files;
}

Status keep_files(Writer& writer, const ReleasePackage& package, Release& release) {
    for (const PackageFile& file : package.files) {
        WEAVE_TRY(const Hash object, writer.put_object(file.bytes));
        release.files.push_back({file.path, object, 0});
    }
    return {};
}

/// Refused unless the release waits for this person's signature.
Status check_signable(const Reader& reader, const Caller& caller, const Release& release) {
    WEAVE_CHECK_OK(check_releaser(reader, caller));
    WEAVE_TRY(const SignedManifest manifest, signed_manifest(reader, release));
    const bool open = release.state == ReleaseStage::prepared ||
                      (release.state == ReleaseStage::released && manifest.people < manifest.needed);
    if (!open) return deny(Denial::conflict, "the release waits for no signature");
    WEAVE_TRY(const PersonKey key, signing_key(reader, caller.id));
    for (const ReleaseSignature& one : release.signatures)
        if (one.key == key.id) return deny(Denial::conflict, "you have signed it already");
    return {};
}

}  // namespace

/// A release that was read back and found sound, before anybody has signed it.
struct ReleaseDesk::ProvenRelease {
    const ReleaseParts& parts;
    const Validation& validation;
    const ReleasePackage& package;
    std::string body;  ///< of the manifest, canonical
};

Result<Json> ReleaseDesk::release(const Caller& caller, const Ask& ask, const ReleaseWish& wish) {
    Deed deed{"release.made", wish.design, wish.reason, {{"loom", wish.loom}, {"revision", wish.revision}}};
    deed.is_signed = true;
    if (wish.supersedes) deed.data["supersedes"] = *wish.supersedes;
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const ReleaseParts parts, m_desk->store().read([&](const Reader& reader) {
            return parts_of(reader, caller, *m_shelf, wish);
        }));
        WEAVE_CHECK_OK(check_text(wish.reason, "reason"));
        WEAVE_TRY(const FeederMap feeders, feeder_map(parts.cloth->design, parts.profile.profile, wish.feeders));
        const std::string stem = release_stem(wish.design, wish.revision);
        const Validation validation = validate(*parts.cloth, wish.loom, parts.profile, feeders, stem);
        WEAVE_CHECK_OK(m_desk->store().read(
            [&](const Reader& reader) { return check_evidence(reader, parts, validation); }));
        WEAVE_TRY(const ReleasePackage package,
                  proven_package(*parts.cloth, parts.profile.profile, feeders, stem));
        const ManifestTerms terms{m_desk->site(), wish.loom, wish.design, parts.number, m_desk->now()};
        WEAVE_TRY(const ReleaseManifest manifest,
                  manifest_of(terms, parts.found.revision, parts.profile, package));
        const Json body = manifest_body(manifest);
        deed.data["release"] = parts.number;
        deed.data["profile_version"] = parts.profile.version;
        deed.data["feeders"] = wish.feeders;
        deed.data["files"] = files_json(package);
        deed.data["sha256"] = hash_hex(parts.found.revision.hash);
        deed.data["manifest_body_sha256"] = body_sha256({body, {}});
        deed.also = {{Purpose::release_manifest, canonical_json(body)}};
        return store_release(caller, ask, deed, wish, {parts, validation, package, canonical_json(body)});
    });
}

/// Takes the first signature over the manifest, and keeps the release.
Result<Json> ReleaseDesk::store_release(const Caller& caller, const Ask& ask, const Deed& deed,
                                        const ReleaseWish& wish, const ProvenRelease& proven) {
    const ReleaseParts& parts = proven.parts;
    return m_desk->commit(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_TRY(const ReleaseParts again, parts_of(reader, now, *m_shelf, wish));
            WEAVE_CHECK_OK(check_evidence(reader, again, proven.validation));
            if (again.number == parts.number && again.profile.version == parts.profile.version) return {};
            return deny(Denial::conflict, "the loom changed meanwhile: try again");
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            Release made;
            made.loom = parts.loom.id;
            made.revision = parts.found.revision.id;
            made.profile_version = parts.profile.version;
            made.feeders = canonical_json(Json(wish.feeders));
            made.event = step.event;
            WEAVE_TRY(made.manifest, writer.put_object(proven.body));
            WEAVE_CHECK_OK(keep_files(writer, proven.package, made));
            WEAVE_TRY(const Release stored, writer.add_release(made));
            WEAVE_CHECK_OK(log_validation(writer, *m_desk, ask.request, parts.found, proven.validation));
            const Signature& signature = step.also.front();
            WEAVE_CHECK_OK(writer.sign_release(stored.id, {signature.key, signature.value, step.event}));
            const Deed next = in_force(wish.design, wish.reason, wish.loom, stored.number);
            return signed_answer(writer, stored.id, m_desk->statement_of(caller.login, ask.request, next));
        });
}

Result<Json> ReleaseDesk::sign(const Caller& caller, const Ask& ask, const std::string& loom,
                               std::int64_t number, const std::string& reason) {
    Deed deed{"release.signed", {}, reason, {{"loom", loom}, {"release", number}}};
    deed.is_signed = true;
    const auto check = [&](const Reader& reader, const Caller& now) -> Status {
        WEAVE_CHECK_OK(need_role(now, PersonRole::approver));
        WEAVE_CHECK_OK(check_text(reason, "reason"));
        WEAVE_TRY(const FoundRelease found, find_release(reader, now, loom, number));
        return check_signable(reader, now, found.release);
    };
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        Id id = 0;
        std::string design;
        const auto unsigned_body = [&](const Reader& reader) -> Result<std::string> {
            WEAVE_TRY(const Caller now, fresh_caller(reader, caller));
            WEAVE_CHECK_OK(check(reader, now));
            WEAVE_TRY(const FoundRelease found, find_release(reader, now, loom, number));
            id = found.release.id;
            WEAVE_TRY(const FoundRevision released, revision_of(reader, found.release));
            design = released.design.name;
            WEAVE_TRY(const auto text, reader.object(found.release.manifest));
            return text.value_or("");
        };
        WEAVE_TRY(const std::string body, m_desk->store().read(unsigned_body));
        deed.subject = design;
        deed.data["manifest_body_sha256"] = hash_hex(sha256(body));
        deed.also = {{Purpose::release_manifest, body}};
        return m_desk->commit(
            caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                const Signature& signature = step.also.front();
                WEAVE_CHECK_OK(writer.sign_release(id, {signature.key, signature.value, step.event}));
                const Deed next = in_force(design, reason, loom, number);
                return signed_answer(writer, id, m_desk->statement_of(caller.login, ask.request, next));
            });
    });
}

Result<Json> ReleaseDesk::withdraw(const Caller& caller, const Ask& ask, const std::string& loom,
                                   std::int64_t number, const std::string& reason) {
    WEAVE_TRY(std::string design, m_desk->store().read([&](const Reader& reader) -> Result<std::string> {
        return design_of(reader, caller, loom, number);
    }));
    Deed deed{"release.withdrawn", std::move(design), reason, {{"loom", loom}, {"release", number}}};
    deed.is_signed = true;
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            if (!now.is(PersonRole::approver)) WEAVE_CHECK_OK(need_role(now, PersonRole::engineer));
            WEAVE_CHECK_OK(check_text(reason, "reason"));
            WEAVE_TRY(const FoundRelease found, find_release(reader, now, loom, number));
            if (found.release.state == ReleaseStage::released ||
                found.release.state == ReleaseStage::prepared)
                return {};
            return deny(Denial::conflict, std::string("the release is ") + release_word(found.release.state) +
                                              " already: no loom takes it any more");
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(const FoundRelease found, find_release(writer, caller, loom, number));
            WEAVE_CHECK_OK(writer.set_release_state(found.release.id, ReleaseStage::withdrawn, step.event));
            WEAVE_CHECK_OK(leave_looms(writer, found.release.revision, RevisionState::withdrawn, step.event));
            return Json{{"loom", loom}, {"number", number}, {"state", "withdrawn"}};
        });
}

}  // namespace weave::loomlink
