#include <algorithm>
#include <loomlink/workflow/told.hpp>

namespace weave::loomlink {

namespace {

std::string name_of(const std::string& loom, std::int64_t number) {
    return "release " + std::to_string(number) + " of " + loom;
}

bool is_live(ReleaseStage stage) {
    return stage == ReleaseStage::prepared || stage == ReleaseStage::released;
}

}  // namespace

void ToldLooms::add_profile(const Telling& told) {
    ToldLoom& loom = m_looms[told.subject()];
    m_things.push_back(
        kept_thing("profile " + std::to_string(++loom.profiles) + " of " + told.subject(),
                   {told.text("document_sha256"), told.seq()}));
}

void ToldLooms::added(const Telling& told) {
    m_things.push_back(kept_thing("loom " + told.subject(), {told.seq()}));
    add_profile(told);
}

/// Releases for another profile than the loom has can no longer be woven.
void ToldLooms::profile_set(const Telling& told) {
    add_profile(told);
    const auto& releases = m_looms.at(told.subject()).releases;
    for (std::size_t k = 0; k < releases.size(); ++k) {
        const ReleaseStage stage = releases[k].stage;
        if (!is_live(stage)) continue;
        come_to(told.subject(), k,
                stage == ReleaseStage::released ? ReleaseStage::superseded : ReleaseStage::withdrawn,
                told.seq());
    }
}

void ToldLooms::operators_set(const Telling& told) {
    ToldLoom& loom = m_looms.at(told.subject());
    loom.operators.clear();
    for (const Json& login : told.data("operators")) loom.operators[login.get<std::string>()] = told.seq();
}

void ToldLooms::place_kept(const Telling& told) {
    m_places["place in " + name_of(told.subject(), told.number("release"))] = {told.number("pick"),
                                                                               told.actor()};
}

void ToldLooms::loaded(const Telling& told) {
    m_things.push_back(kept_thing("loading of record " + std::to_string(told.seq()),
                                  {told.number("release"), told.subject(), told.actor()}));
}

void ToldLooms::fault_reported(const Telling& told) {
    const Json& data = told.record.statement.data;
    m_things.push_back(kept_thing("fault of record " + std::to_string(told.seq()),
                                  {told.number("release"), told.subject(),
                                   data.contains("pick") ? data.at("pick") : Json(nullptr), told.reason(),
                                   told.actor()}));
}

void ToldLooms::release_made(const Telling& told) {
    const std::string loom = told.text("loom");
    auto& releases = m_looms.at(loom).releases;
    releases.push_back({told.subject(), told.number("revision"), ReleaseStage::prepared});
    const std::string name = name_of(loom, static_cast<std::int64_t>(releases.size()));
    m_things.push_back(kept_thing(name, {told.number("revision"), told.subject(),
                                         told.number("profile_version"),
                                         canonical_json(told.data("feeders")),
                                         told.text("manifest_body_sha256"), told.seq()}));
    for (const auto& [file, hash] : told.data("files").items())
        m_things.push_back(kept_thing(file + ", file of " + name, Json::array({hash})));
    come_to(loom, releases.size() - 1, ReleaseStage::prepared, told.seq());
    release_signed(told);
}

void ToldLooms::release_signed(const Telling& told) {
    const std::string name = name_of(told.text("loom"), told.number("release"));
    m_things.push_back(
        kept_thing(by_record("signature of " + name, told.seq()), {told.record.signature.value().key}));
}

void ToldLooms::release_in_force(const Telling& told) {
    const std::string loom = told.text("loom");
    ToldRelease& next = release(told);
    auto& releases = m_looms.at(loom).releases;
    come_to(loom, static_cast<std::size_t>(&next - releases.data()), ReleaseStage::released, told.seq());
    if (m_designs->state_of(next.design, next.revision) == RevisionState::approved)
        m_designs->came_to(next.design, next.revision, RevisionState::released, told.seq());
    for (std::size_t k = 0; k < releases.size(); ++k) {
        const ToldRelease& before = releases[k];
        if (&before == &next || before.design != next.design || before.stage != ReleaseStage::released)
            continue;
        come_to(loom, k, ReleaseStage::superseded, told.seq());
        leave_looms(before, RevisionState::superseded, told.seq());
    }
}

void ToldLooms::release_withdrawn(const Telling& told) {
    const std::string loom = told.text("loom");
    const ToldRelease& gone = release(told);
    come_to(loom, static_cast<std::size_t>(&gone - m_looms.at(loom).releases.data()), ReleaseStage::withdrawn,
            told.seq());
    leave_looms(gone, RevisionState::withdrawn, told.seq());
}

ToldLooms::ToldRelease& ToldLooms::release(const Telling& told) {
    return m_looms.at(told.text("loom")).releases.at(static_cast<std::size_t>(told.number("release")) - 1);
}

void ToldLooms::come_to(const std::string& loom, std::size_t index, ReleaseStage stage, Seq seq) {
    m_looms.at(loom).releases.at(index).stage = stage;
    const std::string name = name_of(loom, static_cast<std::int64_t>(index) + 1);
    m_things.push_back(kept_thing(by_record("state of " + name, seq), {word(stage)}));
}

void ToldLooms::leave_looms(const ToldRelease& release, RevisionState state, Seq seq) {
    const auto stays = [&](const ToldRelease& one) {
        return one.design == release.design && one.revision == release.revision && is_live(one.stage);
    };
    for (const auto& [name, loom] : m_looms)
        if (std::any_of(loom.releases.begin(), loom.releases.end(), stays)) return;
    if (m_designs->state_of(release.design, release.revision) == RevisionState::released)
        m_designs->came_to(release.design, release.revision, state, seq);
}

void ToldLooms::add_to(std::vector<KeptThing>& things) const {
    things.insert(things.end(), m_things.begin(), m_things.end());
    for (const auto& [name, loom] : m_looms)
        for (const auto& [login, seq] : loom.operators)
            things.push_back(kept_thing(login + ", operator of " + name, {seq}));
    for (const auto& [place, kept] : m_places)
        things.push_back(kept_thing(place, {kept.first, kept.second}));
}

}  // namespace weave::loomlink
