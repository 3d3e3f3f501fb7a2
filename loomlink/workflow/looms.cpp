#include <loomlink/workflow/looms.hpp>

#include <weave/core/text.hpp>

#include <algorithm>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/names.hpp>
#include <loomlink/workflow/releases.hpp>
#include <loomlink/workflow/validation.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_profile = std::size_t{1} << 20;

Result<LoomProfile> read_bounded(const std::string& text) {
    if (text.size() > most_profile) return bad_input("has more than 1 MiB", "profile");
    auto profile = read_profile(text);
    if (!profile) return std::move(profile).error().under("profile");
    return profile;
}

/// Releases for another profile than the loom has can no longer be woven.
Status end_releases(Writer& writer, Id loom, Seq event) {
    WEAVE_TRY(const auto releases, writer.releases(loom));
    for (const Release& release : releases) {
        if (release.state == ReleaseStage::released)
            WEAVE_CHECK_OK(writer.set_release_state(release.id, ReleaseStage::superseded, event));
        if (release.state == ReleaseStage::prepared)
            WEAVE_CHECK_OK(writer.set_release_state(release.id, ReleaseStage::withdrawn, event));
    }
    return {};
}

Result<Release> own_release(const Reader& reader, const Caller& caller, const std::string& loom,
                            std::int64_t number) {
    WEAVE_CHECK_OK(find_own_loom(reader, caller, loom));
    WEAVE_TRY(FoundRelease found, find_release(reader, caller, loom, number));
    WEAVE_TRY(const std::string now, state_now(reader, found.release));
    if (now == release_word(ReleaseStage::released)) return std::move(found.release);
    return deny(Denial::conflict,
                (now == "awaiting" ? "the release waits for signatures" : "the release is " + now) +
                    ": it must not be woven");
}

Status check_place(const Reader& reader, const Release& release, std::optional<std::int64_t> pick,
                   std::optional<std::int64_t> end) {
    WEAVE_TRY(const auto revision, reader.revision(release.revision));
    return check_on_card(*revision, pick, end);
}

/// The release that was confirmed last, as long as it may be woven.
Result<std::optional<Release>> loaded_release(const Reader& reader, Id loom) {
    WEAVE_TRY(auto releases, reader.releases(loom));
    std::optional<Release> newest;
    Seq when = 0;
    for (Release& release : releases) {
        WEAVE_TRY(const auto loaded, reader.loaded(release.id));
        if (loaded.empty() || loaded.back().event < when) continue;
        when = loaded.back().event;
        newest = std::move(release);
    }
    return newest;
}

Result<std::vector<Loom>> looms_open_to(const Reader& reader, const Caller& caller) {
    if (caller.reads_designs() || caller.is(PersonRole::administrator)) return reader.looms();
    if (caller.is(PersonRole::operator_)) return reader.looms_of(caller.id);
    return std::vector<Loom>();
}

Result<Json> loom_entry(const Reader& reader, const Loom& loom) {
    WEAVE_TRY(const ProfileInForce profile, profile_in_force(reader, loom.id));
    WEAVE_TRY(const auto releases, reader.releases(loom.id));
    WEAVE_TRY(const auto loaded, loaded_release(reader, loom.id));
    Json text = nullptr;
    if (loaded) {
        WEAVE_TRY(const FoundRevision found, revision_of(reader, *loaded));
        text = found.design.name + ", release " + std::to_string(loaded->number);
    }
    std::int64_t released = 0;
    for (const Release& release : releases) {
        WEAVE_TRY(const std::string now, state_now(reader, release));
        if (now == release_word(ReleaseStage::released)) ++released;
    }
    return Json{{"name", loom.name},
                {"profile_name", profile.profile.name},
                {"released", released},
                {"loaded", std::move(text)}};
}

Result<Json> releases_of_loom(const Reader& reader, const Loom& loom) {
    WEAVE_TRY(const auto releases, reader.releases(loom.id));
    Json list = Json::array();
    for (const Release& release : releases) {
        WEAVE_TRY(const FoundRevision found, revision_of(reader, release));
        WEAVE_TRY(const LastStep step, last_step(reader, release));
        WEAVE_TRY(const auto bookmark, reader.bookmark(release.id));
        WEAVE_TRY(const std::string now, state_now(reader, release));
        list.push_back({{"number", release.number},
                        {"design", found.design.name},
                        {"revision", found.revision.number},
                        {"state", now},
                        {"at", step.at},
                        {"since", step.at},
                        {"by", step.by},
                        {"reason", step.reason},
                        {"picks", found.revision.picks},
                        {"ends", found.revision.ends},
                        {"place", bookmark ? Json(bookmark->pick) : Json(nullptr)}});
    }
    return list;
}

Result<Json> faults_of_loom(const Reader& reader, const Loom& loom) {
    WEAVE_TRY(const auto releases, reader.releases(loom.id));
    Json list = Json::array();
    for (const Release& release : releases) {
        WEAVE_TRY(const auto faults, reader.faults(release.id));
        for (auto fault = faults.rbegin(); fault != faults.rend(); ++fault) {
            WEAVE_TRY(const EventRecord record, reader.record(fault->event));
            WEAVE_TRY(const std::string by, full_name_of(reader, fault->person));
            const Json& data = record.statement.data;
            list.push_back({{"release", release.number},
                            {"pick", fault->pick ? Json(*fault->pick) : Json(nullptr)},
                            {"end", data.contains("end") ? data.at("end") : Json(nullptr)},
                            {"text", fault->text},
                            {"by", by},
                            {"at", record.statement.at}});
        }
    }
    return list;
}

}  // namespace

Result<FoundRevision> revision_of(const Reader& reader, const Release& release) {
    WEAVE_TRY(auto revision, reader.revision(release.revision));
    WEAVE_TRY(const auto designs, reader.designs());
    for (const Design& design : designs)
        if (revision && design.id == revision->design) return FoundRevision{design, *std::move(revision)};
    return system_fault("the store is damaged: the revision of a release is missing");
}

Result<Json> LoomDesk::add(const Caller& caller, const Ask& ask, const std::string& name,
                           const std::string& text) {
    Deed deed{"loom.added", name, {}, Json::object()};
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const LoomProfile profile, read_bounded(text));
        deed.data["profile_sha256"] = profile.sha256;
        deed.data["document_sha256"] = hash_hex(sha256(text));
        return m_desk->commit(
            caller, ask, deed,
            [&](const Reader& reader, const Caller& now) -> Status {
                WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
                WEAVE_CHECK_OK(check_name(name, "name", true));
                WEAVE_TRY(const auto looms, reader.looms());
                return check_free(looms, name, "loom");
            },
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_TRY(const Id loom, writer.add_loom(name, step.event));
                WEAVE_TRY(const Hash object, writer.put_object(text));
                WEAVE_TRY(const std::int64_t version, writer.add_profile(loom, object, step.event));
                return Json{{"name", name}, {"profile_version", version}};
            });
    });
}

Result<Json> LoomDesk::set_profile(const Caller& caller, const Ask& ask, const std::string& loom,
                                   const std::string& text) {
    Deed deed{"loom.profile_set", loom, "a new version of the loom's profile is in force", Json::object()};
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        WEAVE_TRY(const LoomProfile profile, read_bounded(text));
        deed.data["profile_sha256"] = profile.sha256;
        deed.data["document_sha256"] = hash_hex(sha256(text));
        return m_desk->commit(
            caller, ask, deed,
            [&](const Reader& reader, const Caller& now) -> Status {
                WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
                WEAVE_TRY(const Loom found, find_loom(reader, now, loom));
                WEAVE_TRY(const ProfileInForce until_now, profile_in_force(reader, found.id));
                if (until_now.profile.sha256 != profile.sha256) return {};
                return deny(Denial::conflict, "this is the profile that is in force: its releases would end for nothing");
            },
            [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                WEAVE_TRY(const Loom found, find_loom(writer, caller, loom));
                WEAVE_TRY(const Hash object, writer.put_object(text));
                WEAVE_TRY(const std::int64_t version, writer.add_profile(found.id, object, step.event));
                WEAVE_CHECK_OK(end_releases(writer, found.id, step.event));
                return Json{{"name", loom}, {"profile_version", version}};
            });
    });
}

Result<Json> LoomDesk::set_operators(const Caller& caller, const Ask& ask, const std::string& loom,
                                     const std::vector<std::string>& names) {
    const Deed deed{"loom.operators_set", loom, {}, {{"operators", names}}};
    const auto people = [&](const Reader& reader) -> Result<std::vector<Person>> {
        std::vector<Person> list;
        for (const std::string& name : names) {
            WEAVE_TRY(const auto person, reader.person(name));
            if (!person) return bad_input("names " + on_one_line(name) + ", who is not there", "operators");
            if (!caller_of(*person).is(PersonRole::operator_))
                return bad_input("names " + on_one_line(name) + ", who is no operator", "operators");
            list.push_back(*person);
        }
        return list;
    };
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::administrator));
            WEAVE_CHECK_OK(find_loom(reader, now, loom));
            const auto found = people(reader);
            return found ? Status() : Status(found.error());
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_TRY(const Loom found, find_loom(writer, caller, loom));
            WEAVE_TRY(const auto before, writer.operators(found.id));
            for (const Person& person : before) WEAVE_CHECK_OK(writer.disallow_operator(found.id, person.id));
            WEAVE_TRY(const auto now, people(writer));
            for (const Person& person : now)
                WEAVE_CHECK_OK(writer.allow_operator(found.id, person.id, step.event));
            return Json{{"operators", names}};
        });
}

Result<Json> LoomDesk::list(const Caller& caller) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const auto looms, looms_open_to(reader, caller));
        Json list = Json::array();
        for (const Loom& loom : looms) {
            WEAVE_TRY(Json entry, loom_entry(reader, loom));
            list.push_back(std::move(entry));
        }
        return Json{{"looms", std::move(list)}};
    });
}

Result<Json> LoomDesk::read(const Caller& caller, const std::string& name) {
    const auto told = [&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const Loom loom, find_loom(reader, caller, name));
        WEAVE_TRY(const ProfileInForce in_force, profile_in_force(reader, loom.id));
        WEAVE_TRY(const auto loaded, loaded_release(reader, loom.id));
        WEAVE_TRY(const auto people, reader.operators(loom.id));
        const LoomProfile& profile = in_force.profile;
        Json operators = Json::array();
        for (const Person& person : people) operators.push_back(person.login);
        Json json{{"name", loom.name},
                  {"profile_name", profile.name},
                  {"profile_version", in_force.version},
                  {"profile_sha256", profile.sha256},
                  {"hooks", profile.total_hooks},
                  {"feeders", profile.feeders},
                  {"output", name_of(profile.output)},
                  {"operators", std::move(operators)},
                  {"loaded", loaded ? Json(loaded->number) : Json(nullptr)}};
        WEAVE_TRY(json["releases"], releases_of_loom(reader, loom));
        WEAVE_TRY(json["faults"], faults_of_loom(reader, loom));
        return json;
    };
    return m_desk->look(caller, {"loom.viewed", name}, [&] { return m_desk->store().read(told); });
}

Result<Json> LoomDesk::keep_place(const Caller& caller, const Ask& ask, const std::string& loom,
                                  std::int64_t release, std::int64_t pick) {
    const Deed deed{"loom.place_kept", loom, {}, {{"release", release}, {"pick", pick}}};
    const auto check = [&](const Reader& reader, const Caller& now) -> Status {
        WEAVE_TRY(const Release found, own_release(reader, now, loom, release));
        return check_place(reader, found, pick, {});
    };
    return m_desk->take(caller, ask, deed, check, [&](Writer& writer, const TakenStep&) -> Result<Json> {
        WEAVE_TRY(const Release found, own_release(writer, caller, loom, release));
        WEAVE_CHECK_OK(writer.set_bookmark({found.id, pick, caller.id}));
        return Json{{"release", release}, {"place", pick}};
    });
}

Result<Json> LoomDesk::confirm_loaded(const Caller& caller, const Ask& ask, const std::string& loom,
                                      std::int64_t release) {
    const Deed deed{"loom.loaded", loom, {}, {{"release", release}}};
    const auto check = [&](const Reader& reader, const Caller& now) -> Status {
        const auto found = own_release(reader, now, loom, release);
        return found ? Status() : Status(found.error());
    };
    return m_desk->take(caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
        WEAVE_TRY(const Release found, own_release(writer, caller, loom, release));
        WEAVE_CHECK_OK(writer.add_loaded({found.id, caller.id, step.event}));
        return Json{{"loaded", release}};
    });
}

Result<Json> LoomDesk::report_fault(const Caller& caller, const Ask& ask, const std::string& loom,
                                    std::int64_t release, const std::string& text,
                                    std::optional<std::int64_t> pick, std::optional<std::int64_t> end) {
    Deed deed{"loom.fault_reported", loom, text, {{"release", release}}};
    if (pick) deed.data["pick"] = *pick;
    if (end) deed.data["end"] = *end;
    const auto check = [&](const Reader& reader, const Caller& now) -> Status {
        WEAVE_CHECK_OK(find_own_loom(reader, now, loom));
        WEAVE_CHECK_OK(check_text(text, "text"));
        WEAVE_TRY(const FoundRelease found, find_release(reader, now, loom, release));
        return check_place(reader, found.release, pick, end);
    };
    return m_desk->take(caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
        WEAVE_TRY(const FoundRelease found, find_release(writer, caller, loom, release));
        WEAVE_CHECK_OK(writer.add_fault({found.release.id, pick, text, caller.id, step.event}));
        return Json::object();
    });
}

}  // namespace weave::loomlink
