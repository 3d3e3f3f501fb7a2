#include <loomlink/workflow/designs.hpp>

#include <weave/design/document.hpp>

#include <algorithm>
#include <loomlink/workflow/accounts.hpp>
#include <loomlink/workflow/names.hpp>

namespace weave::loomlink {

namespace {

constexpr std::size_t most_parents = 16;

Result<Json> newest_json(const Reader& reader, const Design& design) {
    WEAVE_TRY(const auto revisions, reader.revisions(design.id));
    if (revisions.empty()) return Json(nullptr);
    const Revision& newest = revisions.back();
    WEAVE_TRY(const std::string author, full_name_of(reader, newest.author));
    return Json{{"number", newest.number}, {"message", newest.message}, {"state", word(newest.state)},
                {"at", newest.at},         {"author", author},          {"ends", newest.ends},
                {"picks", newest.picks}};
}

/// The number of each revision by its id.
std::map<Id, std::int64_t> numbers_of(const std::vector<Revision>& revisions) {
    std::map<Id, std::int64_t> numbers;
    for (const Revision& revision : revisions) numbers[revision.id] = revision.number;
    return numbers;
}

Json parents_json(const Revision& revision, const std::map<Id, std::int64_t>& numbers) {
    Json parents = Json::array();
    for (const Id parent : revision.parents) parents.push_back(numbers.at(parent));
    return parents;
}

Result<Json> revisions_json(const Reader& reader, const std::vector<Revision>& revisions,
                            const std::vector<Branch>& branches) {
    const auto numbers = numbers_of(revisions);
    Json list = Json::array();
    for (auto revision = revisions.rbegin(); revision != revisions.rend(); ++revision) {
        WEAVE_TRY(const std::string author, full_name_of(reader, revision->author));
        Json heads = Json::array();
        for (const Branch& branch : branches)
            if (branch.head == revision->id) heads.push_back(branch.name);
        list.push_back({{"number", revision->number},
                        {"parents", parents_json(*revision, numbers)},
                        {"state", word(revision->state)},
                        {"author", author},
                        {"at", revision->at},
                        {"message", revision->message},
                        {"sha256", hash_hex(revision->hash)},
                        {"branches", std::move(heads)}});
    }
    return list;
}

Result<Json> releases_json(const Reader& reader, const std::vector<Revision>& revisions) {
    WEAVE_TRY(const auto looms, reader.looms());
    Json list = Json::array();
    for (const Revision& revision : revisions) {
        WEAVE_TRY(const auto releases, reader.releases_of(revision.id));
        for (const Release& release : releases) {
            const auto loom = std::find_if(looms.begin(), looms.end(),
                                           [&](const Loom& one) { return one.id == release.loom; });
            list.push_back(
                {{"loom", loom == looms.end() ? "" : loom->name},
                 {"number", release.number},
                 {"revision", revision.number},
                 {"state", release.state == ReleaseStage::prepared ? "awaiting" : word(release.state)}});
        }
    }
    return list;
}

/// The parents of what is saved: the branch's head first, then the others that are named, each once.
std::vector<std::int64_t> parent_numbers(const SaveWish& wish) {
    std::vector<std::int64_t> numbers;
    if (wish.expected) numbers.push_back(*wish.expected);
    for (const std::int64_t number : wish.also)
        if (std::find(numbers.begin(), numbers.end(), number) == numbers.end()) numbers.push_back(number);
    return numbers;
}

Result<std::vector<Id>> parents_of(const Reader& reader, Id design, const SaveWish& wish) {
    std::vector<Id> parents;
    for (const std::int64_t number : parent_numbers(wish)) {
        WEAVE_TRY(const auto parent, reader.revision(design, number));
        if (!parent) return deny(Denial::absent, "the design has no revision " + std::to_string(number));
        parents.push_back(parent->id);
    }
    return parents;
}

/// Refused where the branch is not where the caller believes it to be, or holds this very document: what
/// changes nothing is no revision, unless it joins branches.
Status check_head(const Reader& reader, Id design, const SaveWish& wish, const Hash& document) {
    WEAVE_TRY(const auto branches, reader.branches(design));
    const auto branch = std::find_if(branches.begin(), branches.end(),
                                     [&](const Branch& one) { return one.name == wish.branch; });
    if (branch == branches.end()) {
        return check_free(branches, wish.branch, "branch");  // a new one starts where `expected` says
    }
    WEAVE_TRY(const auto parents, parents_of(reader, design, wish));  // a revision that is not there is no head either
    WEAVE_TRY(const auto head, reader.revision(branch->head));
    if (!head || wish.expected != head->number)
        return deny(Denial::conflict, "the branch has moved on" +
                                          (head ? " to revision " + std::to_string(head->number) : "") +
                                          ": somebody else saved first; compare and merge");
    if (parents.size() > 1 || head->document != document) return {};
    return deny(Denial::conflict,
                "this is what revision " + std::to_string(head->number) + " holds already: nothing to save");
}

Status check_wish(const SaveWish& wish) {
    WEAVE_CHECK_OK(check_name(wish.branch, "branch", false));
    WEAVE_CHECK_OK(check_text(wish.message, "message"));
    if (wish.also.size() > most_parents) return bad_input("names more than 16 revisions", "also");
    return {};
}

Revision revision_of(const RevisionCloth& cloth, const SaveWish& wish) {
    Revision made;
    made.message = wish.message;
    made.design_sha256 = *parse_hash(design_sha256(cloth.design));
    made.scene_sha256 = *parse_hash(scene_sha256(cloth.design));
    made.card_sha256 = *parse_hash(cloth.card.sha256());
    made.picks = static_cast<std::int64_t>(cloth.card.picks());
    made.ends = static_cast<std::int64_t>(cloth.card.ends());
    return made;
}

/// All that the log tells of a revision beside its document and message.
void tell_revision(const Revision& made, const SaveWish& wish, Json& data) {
    data["design_sha256"] = hash_hex(made.design_sha256);
    data["scene_sha256"] = hash_hex(made.scene_sha256);
    data["card_sha256"] = hash_hex(made.card_sha256);
    data["picks"] = made.picks;
    data["ends"] = made.ends;
    data["parents"] = parent_numbers(wish);
}

/// Adds the revision behind its parents and moves the branch to it.
Result<Revision> store_revision(Writer& writer, const Caller& caller, Revision made, const SaveWish& wish) {
    WEAVE_TRY(const Design design, find_design(writer, caller, wish.design));
    made.design = design.id;
    WEAVE_TRY(made.parents, parents_of(writer, design.id, wish));
    WEAVE_TRY(made.document, writer.put_object(wish.document));
    WEAVE_TRY(const auto branches, writer.branches(design.id));
    const auto branch = std::find_if(branches.begin(), branches.end(),
                                     [&](const Branch& one) { return one.name == wish.branch; });
    const std::optional<Id> expected = branch == branches.end() ? std::nullopt : std::optional(branch->head);
    WEAVE_TRY(Revision stored, writer.add_revision(made));
    WEAVE_CHECK_OK(writer.move_branch({design.id, wish.branch, stored.id, made.event}, expected));
    return stored;
}

}  // namespace

Result<Json> DesignDesk::add(const Caller& caller, const Ask& ask, const std::string& name) {
    const Deed deed{"design.added", name, {}, Json::object()};
    return m_desk->take(
        caller, ask, deed,
        [&](const Reader& reader, const Caller& now) -> Status {
            WEAVE_CHECK_OK(need_role(now, PersonRole::designer));
            WEAVE_CHECK_OK(check_name(name, "name", false));
            WEAVE_TRY(const auto designs, reader.designs());
            return check_free(designs, name, "design");
        },
        [&](Writer& writer, const TakenStep& step) -> Result<Json> {
            WEAVE_CHECK_OK(writer.add_design(name, step.event));
            return Json{{"name", name}};
        });
}

Result<Json> DesignDesk::save(const Caller& caller, const Ask& ask, const SaveWish& wish) {
    const Hash document = sha256(wish.document);
    Deed deed{"revision.saved",
              wish.design,
              {},
              {{"branch", wish.branch}, {"document_sha256", hash_hex(document)}, {"message", wish.message}}};
    if (wish.expected) deed.data["expected"] = *wish.expected;
    const auto check = [&](const Reader& reader, const Caller& now) -> Status {
        WEAVE_CHECK_OK(need_role(now, PersonRole::designer));
        WEAVE_CHECK_OK(check_wish(wish));
        WEAVE_TRY(const Design design, find_design(reader, now, wish.design));
        WEAVE_CHECK_OK(check_head(reader, design.id, wish, document));
        const auto parents = parents_of(reader, design.id, wish);
        return parents ? Status() : Status(parents.error());
    };
    return m_desk->attempt(caller, ask, deed, [&]() -> Result<Json> {
        // Nothing is woven for who may not save it.
        WEAVE_CHECK_OK(m_desk->store().read([&](const Reader& reader) -> Status {
            WEAVE_TRY(const Caller now, fresh_caller(reader, caller));
            return check(reader, now);
        }));
        WEAVE_TRY(const RevisionClothPtr cloth, weave_document(wish.document));
        Revision made = revision_of(*cloth, wish);
        made.author = caller.id;
        tell_revision(made, wish, deed.data);
        return m_desk->commit(
            caller, ask, deed, check, [&](Writer& writer, const TakenStep& step) -> Result<Json> {
                made.event = step.event;
                made.at = step.at;
                WEAVE_TRY(const Revision stored, store_revision(writer, caller, made, wish));
                m_shelf->keep(document, cloth);
                return Json{{"number", stored.number}, {"sha256", hash_hex(stored.hash)}};
            });
    });
}

Result<Json> DesignDesk::list(const Caller& caller) {
    return m_desk->store().read([&](const Reader& reader) -> Result<Json> {
        WEAVE_CHECK_OK(need_designs_open(caller));
        WEAVE_TRY(const auto designs, reader.designs());
        Json list = Json::array();
        for (const Design& design : designs) {
            WEAVE_TRY(Json newest, newest_json(reader, design));
            list.push_back({{"name", design.name}, {"newest", std::move(newest)}});
        }
        return Json{{"designs", std::move(list)}};
    });
}

Result<Json> DesignDesk::graph(const Caller& caller, const std::string& name) {
    const auto told = [&](const Reader& reader) -> Result<Json> {
        WEAVE_TRY(const Design design, find_design(reader, caller, name));
        WEAVE_TRY(const auto revisions, reader.revisions(design.id));
        WEAVE_TRY(const auto branches, reader.branches(design.id));
        const auto numbers = numbers_of(revisions);
        Json heads = Json::array();
        for (const Branch& branch : branches)
            heads.push_back({{"name", branch.name}, {"head", numbers.at(branch.head)}});
        WEAVE_TRY(Json list, revisions_json(reader, revisions, branches));
        WEAVE_TRY(Json releases, releases_json(reader, revisions));
        return Json{{"name", design.name},
                    {"branches", std::move(heads)},
                    {"revisions", std::move(list)},
                    {"releases", std::move(releases)}};
    };
    return m_desk->look(caller, {"design.viewed", name}, [&] { return m_desk->store().read(told); });
}

}  // namespace weave::loomlink
