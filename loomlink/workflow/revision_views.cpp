#include <weave/core/text.hpp>
#include <weave/design/document.hpp>
#include <weave/diff/design_diff.hpp>
#include <weave/picture/diff_view.hpp>
#include <weave/picture/picture.hpp>

#include <algorithm>
#include <array>
#include <loomlink/workflow/designs.hpp>
#include <loomlink/workflow/missing.hpp>
#include <loomlink/workflow/release_files.hpp>
#include <loomlink/workflow/rules.hpp>
#include <sstream>

namespace weave::loomlink {

namespace {

Result<Json> decisions_json(const Reader& reader, const Revision& revision) {
    WEAVE_TRY(const auto decisions, reader.decisions(revision.id));
    Json list = Json::array();
    for (const Decision& decision : decisions) {
        WEAVE_TRY(const EventRecord record, reader.record(decision.event));
        WEAVE_TRY(const std::string by, full_name_of(reader, decision.person));
        list.push_back({{"what", decision.kind == DecisionKind::approve ? "approved" : "changes requested"},
                        {"by", by},
                        {"at", record.statement.at},
                        {"reason", record.statement.reason.value_or("")}});
    }
    return list;
}

/// Who submitted it, when and why; null of a draft.
Result<Json> submission_json(const Reader& reader, const Revision& revision) {
    WEAVE_TRY(const auto steps, reader.revision_steps(revision.id));
    for (const auto& step : steps) {
        if (step.state != RevisionState::submitted) continue;
        WEAVE_TRY(const EventRecord record, reader.record(step.event));
        WEAVE_TRY(const auto person, reader.person(record.statement.actor));
        return Json{{"by", person ? person->full_name : record.statement.actor},
                    {"at", record.statement.at},
                    {"reason", record.statement.reason.value_or("")}};
    }
    return Json(nullptr);
}

Result<Json> waivers_json(const Reader& reader, const Revision& revision) {
    WEAVE_TRY(const auto waivers, waivers_with_looms(reader, revision.id));
    Json list = Json::array();
    for (const auto& [waiver, loom] : waivers) {
        WEAVE_TRY(const std::string by, full_name_of(reader, waiver.person));
        list.push_back({{"rule", waiver.rule}, {"loom", loom}, {"by", by}, {"reason", waiver.reason}});
    }
    return list;
}

Result<Json> comments_json(const Reader& reader, const Revision& revision) {
    WEAVE_TRY(const auto comments, reader.comments(revision.id));
    Json list = Json::array();
    for (const Comment& comment : comments) {
        WEAVE_TRY(const EventRecord record, reader.record(comment.event));
        WEAVE_TRY(const std::string by, full_name_of(reader, comment.person));
        Json entry{{"by", by}, {"at", record.statement.at}, {"text", comment.text}};
        for (const char* place : {"pick", "end"})
            if (record.statement.data.contains(place)) entry[place] = record.statement.data.at(place);
        list.push_back(std::move(entry));
    }
    return list;
}

std::string result_of(const Validation& validation) {
    return counted(validation.errors, "error") + ", " + counted(validation.warnings, "warning");
}

std::string result_of(const Evidence& evidence) {
    std::ostringstream text;
    text << evidence.fidelity << (evidence.converged ? ", at rest" : ", not at rest");
    if (evidence.residual) text << ", residual " << *evidence.residual;
    return text.str();
}

Result<Json> evidence_json(const Reader& reader, const Design& design, const Revision& revision) {
    Json list = Json::array();
    WEAVE_TRY(const auto validations, validations_of(reader, design, revision));
    for (const Validation& validation : validations) {
        WEAVE_TRY(const std::string stale, why_stale(reader, validation));
        list.push_back(
            {{"kind", "validation"},
             {"covers", validation.loom + ", profile version " + std::to_string(validation.profile_version)},
             {"result", result_of(validation)},
             {"signer", "loomlink"},
             {"at", validation.at},
             {"stale", stale.empty() ? Json(nullptr) : Json(stale)}});
    }
    WEAVE_TRY(const auto simulations, simulations_of(reader, revision));
    for (const KnownSimulation& known : simulations) {
        std::ostringstream covers;
        covers << 100 * known.evidence.coverage << " % of the crossings";
        list.push_back({{"kind", "simulation"},
                        {"covers", covers.str()},
                        {"result", result_of(known.evidence)},
                        {"signer", known.signer},
                        {"at", known.at},
                        {"solver", known.evidence.solver},
                        {"report_sha256", hash_hex(known.evidence.report)},
                        {"result_sha256", known.result_sha256},
                        {"stale", known.stale.empty() ? Json(nullptr) : Json(known.stale)}});
    }
    return list;
}

Json feeders_json(const weave::Design& design) {
    Json list = Json::array();
    for (const Feeder& feeder : design.weft.feeders)
        list.push_back({{"name", feeder.name}, {"yarn", design.weft.yarns[feeder.yarn].name}});
    return list;
}

Result<Json> base_json(const Reader& reader, const FoundRevision& found) {
    const auto& [design, revision] = found;
    WEAVE_TRY(const auto author, reader.person(revision.author));
    Json parents = Json::array();
    for (const Id id : revision.parents) {
        WEAVE_TRY(const auto parent, reader.revision(id));
        if (parent) parents.push_back(parent->number);
    }
    return Json{{"design", design.name},
                {"number", revision.number},
                {"state", word(revision.state)},
                {"message", revision.message},
                {"author", author ? author->login : ""},
                {"author_name", author ? author->full_name : ""},
                {"at", revision.at},
                {"picks", revision.picks},
                {"ends", revision.ends},
                {"parents", std::move(parents)},
                {"sha256", hash_hex(revision.hash)},
                {"document_sha256", hash_hex(revision.document)},
                {"design_sha256", hash_hex(revision.design_sha256)},
                {"scene_sha256", hash_hex(revision.scene_sha256)},
                {"card_sha256", hash_hex(revision.card_sha256)}};
}

Result<View> view_named(const std::string& name) {
    constexpr std::array names{"card", "face", "back", "floats", "layers"};
    constexpr std::array views{View::card, View::face, View::back, View::floats, View::layers};
    const auto place = std::find(names.begin(), names.end(), name);
    if (place == names.end()) return bad_input("must be card, face, back, floats or layers", "view");
    return views[static_cast<std::size_t>(place - names.begin())];
}

/// The summary lines of a diff: what a person reads first.
Json summary_of(const DesignDiff& diff) {
    Json lines = Json::array();
    if (!diff.tree.is_same())
        lines.push_back(counted(diff.tree.blocks.size(), "block") + " of the tree changed");
    if (diff.card && !diff.card->is_same()) lines.push_back(in_words(*diff.card));
    if (!diff.no_card.empty()) lines.push_back("The cards are not compared: " + diff.no_card);
    const std::array<std::pair<const Changes*, const char*>, 4> parts{{{&diff.picks, "picks"},
                                                                       {&diff.ends, "ends"},
                                                                       {&diff.yarns, "yarns"},
                                                                       {&diff.parameters, "parameters"}}};
    for (const auto& [changes, name] : parts)
        if (!changes->empty()) lines.push_back(counted(changes->size(), "change") + " of " + name);
    return lines;
}

/// Whether no approval is possible before somebody simulates.
Result<bool> needs_simulation(const Reader& reader, const Revision& revision) {
    if (revision.state != RevisionState::draft && revision.state != RevisionState::submitted) return false;
    WEAVE_TRY(const SitePolicy policy, policy_in_force(reader));
    WEAVE_TRY(const auto simulations, simulations_of(reader, revision));
    return !missing_simulation(simulations, revision, policy).empty();
}

}  // namespace

Result<Json> revision_json(const Reader& reader, const Caller& caller, const FoundRevision& found,
                           const weave::Design& design) {
    WEAVE_TRY(Json json, base_json(reader, found));
    WEAVE_TRY(json["missing"], missing_for_release(reader, found.design, found.revision));
    WEAVE_TRY(json["waivers"], waivers_json(reader, found.revision));
    WEAVE_TRY(json["evidence"], evidence_json(reader, found.design, found.revision));
    WEAVE_TRY(json["submission"], submission_json(reader, found.revision));
    WEAVE_TRY(json["decisions"], decisions_json(reader, found.revision));
    WEAVE_TRY(json["comments"], comments_json(reader, found.revision));
    json["feeders"] = feeders_json(design);
    WEAVE_TRY(const bool needs, needs_simulation(reader, found.revision));
    json["needs_simulation"] = needs;
    std::vector<std::string> actions = allowed_actions(caller, found.revision);
    if (needs) std::erase(actions, word(Action::approve));
    json["may"] = std::move(actions);
    return json;
}

Result<FoundRevision> DesignDesk::found(const Caller& caller, const std::string& design,
                                        std::int64_t number) {
    return m_desk->look(caller, {"revision.viewed", design, {}, {{"revision", number}}}, [&] {
        return m_desk->store().read(
            [&](const Reader& reader) { return find_revision(reader, caller, design, number); });
    });
}

Result<RevisionClothPtr> DesignDesk::cloth(const Caller& caller, const std::string& design,
                                           std::int64_t number) {
    WEAVE_TRY(const FoundRevision here, found(caller, design, number));
    return m_desk->store().read(
        [&](const Reader& reader) { return m_shelf->find(reader, here.revision.document); });
}

Result<Json> DesignDesk::revision(const Caller& caller, const std::string& design, std::int64_t number) {
    WEAVE_TRY(const RevisionClothPtr woven, cloth(caller, design, number));
    WEAVE_CHECK_OK(m_desk->note_view(caller, "revision.viewed", design, {{"revision", number}}));
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const FoundRevision here, find_revision(reader, caller, design, number));
        return revision_json(reader, caller, here, woven->design);
    });
}

Result<std::string> DesignDesk::document(const Caller& caller, const std::string& design,
                                         std::int64_t number) {
    WEAVE_TRY(const FoundRevision here, found(caller, design, number));
    WEAVE_CHECK_OK(m_desk->note_view(caller, "revision.pulled", design, {{"revision", number}}));
    WEAVE_TRY(auto text, m_desk->store().read(
                             [&](const Reader& reader) { return reader.object(here.revision.document); }));
    if (!text) return system_fault("the store is damaged: a document is missing");
    return *std::move(text);
}

Result<std::string> DesignDesk::picture(const Caller& caller, const std::string& design, std::int64_t number,
                                        const std::string& view) {
    WEAVE_TRY(const View wanted, view_named(view));
    WEAVE_TRY(const RevisionClothPtr woven, cloth(caller, design, number));
    PictureRequest request;
    request.view = wanted;
    return draw(woven->design, woven->evaluation, request, PictureFormat::png);
}

Result<std::string> DesignDesk::card(const Caller& caller, const std::string& design, std::int64_t number,
                                     const CardTile& tile) {
    WEAVE_TRY(const RevisionClothPtr woven, cloth(caller, design, number));
    return draw_tile(woven->card, tile);
}

Result<Json> DesignDesk::check(const Caller& caller, const std::string& design, std::int64_t number,
                               const std::string& loom) {
    WEAVE_TRY(const RevisionClothPtr woven, cloth(caller, design, number));
    const Deed deed{"revision.checked", design, {}, {{"revision", number}, {"loom", loom}}};
    WEAVE_TRY(const ProfileInForce profile, m_desk->look(caller, deed, [&] {
        return m_desk->store().read([&](const Reader& reader) -> Result<ProfileInForce> {
            WEAVE_TRY(const Loom found_loom, find_loom(reader, caller, loom));
            return profile_in_force(reader, found_loom.id);
        });
    }));
    return to_json(check_with_file(*woven, profile.profile, straight_map(woven->design),
                                   release_stem(design, number)));
}

Result<Json> DesignDesk::diff(const Caller& caller, const std::string& design, std::int64_t from,
                              std::int64_t to) {
    WEAVE_TRY(const RevisionClothPtr before, cloth(caller, design, from));
    WEAVE_TRY(const RevisionClothPtr after, cloth(caller, design, to));
    WEAVE_TRY(const WovenDesign old_design, weave_design(before->design));
    WEAVE_TRY(const WovenDesign new_design, weave_design(after->design));
    const DesignDiff found_diff = diff_designs(old_design, new_design);
    Json json = to_json(found_diff);
    json["summary"] = summary_of(found_diff);
    return json;
}

Result<std::string> DesignDesk::diff_picture(const Caller& caller, const std::string& design,
                                             std::int64_t from, std::int64_t to) {
    WEAVE_TRY(const RevisionClothPtr before, cloth(caller, design, from));
    WEAVE_TRY(const RevisionClothPtr after, cloth(caller, design, to));
    WEAVE_TRY(const WovenDesign old_design, weave_design(before->design));
    WEAVE_TRY(const WovenDesign new_design, weave_design(after->design));
    return draw_diff(old_design, new_design, diff_designs(old_design, new_design), PictureFormat::png);
}

}  // namespace weave::loomlink
