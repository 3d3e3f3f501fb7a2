#include <weave/design/edit.hpp>

#include <weave/design/node_json.hpp>
#include <weave/design/plan_json.hpp>
#include <weave/design/tree.hpp>

#include <algorithm>
#include <utility>

namespace weave {

namespace {

/// Names of edits in JSON, in the order of the variant.
const std::vector<std::string> edit_names{"put-block", "remove-block", "rename-block", "set-root",
                                          "put-flip",  "remove-flip",  "set-title",    "set-warp",
                                          "set-weft",  "set-scene"};

Error unknown_block(const std::string& name) {
    return invalid("'" + name.substr(0, 80) + "' is not a block of this design");
}

/// The blocks that are made from `name`.
std::string users_of(const Design& design, const std::string& name) {
    std::string users;
    for (const auto& [user, node] : design.blocks) {
        const auto children = children_of(*node);
        if (std::find(children.begin(), children.end(), name) == children.end()) continue;
        users += (users.empty() ? "" : ", ") + user;
    }
    return users;
}

/// Whether `name` is `node` or one of the blocks that it is made from, however far down.
bool leads_to(const Design& design, const Node& node, const std::string& name) {
    std::vector<std::string> open = children_of(node);
    std::map<std::string, bool> seen;
    while (!open.empty()) {
        const std::string at = std::move(open.back());
        open.pop_back();
        if (at == name) return true;
        if (std::exchange(seen[at], true) || !design.blocks.contains(at)) continue;
        for (std::string& child : children_of(*design.blocks.at(at))) open.push_back(std::move(child));
    }
    return false;
}

NodePtr with_flips(const Node& node, std::vector<Flip> flips) {
    return std::make_shared<const Node>(Node{node.source, std::move(flips)});
}

// Each of these makes one kind of edit and gives its inverse.

Result<Edit> make(Design& design, const PutBlock& edit) {
    if (Status fine = check_block_name(edit.name); !fine) return std::move(fine).error();
    if (!edit.node) return invalid("'" + edit.name + "' would be made from nothing");
    if (Status fine = check(*edit.node); !fine) return std::move(fine).error().under("blocks." + edit.name);
    for (const std::string& child : children_of(*edit.node)) {
        if (!design.blocks.contains(child)) return unknown_block(child);
    }
    if (leads_to(design, *edit.node, edit.name))
        return invalid("'" + edit.name + "' would be made from itself");
    const auto old = design.blocks.find(edit.name);
    if (old == design.blocks.end() && design.blocks.size() >= most_blocks)
        return invalid("a design has at most " + std::to_string(most_blocks) + " blocks");
    Edit undo =
        old == design.blocks.end() ? Edit(RemoveBlock{edit.name}) : Edit(PutBlock{edit.name, old->second});
    design.blocks[edit.name] = edit.node;
    return undo;
}

Result<Edit> make(Design& design, const RemoveBlock& edit) {
    const auto old = design.blocks.find(edit.name);
    if (old == design.blocks.end()) return unknown_block(edit.name);
    if (design.root == edit.name)
        return invalid("'" + edit.name + "' is the cloth itself; choose another root first");
    const std::string users = users_of(design, edit.name);
    if (!users.empty()) return invalid("'" + edit.name + "' is still used by " + users);
    Edit undo = PutBlock{edit.name, old->second};
    design.blocks.erase(old);
    return undo;
}

Result<Edit> make(Design& design, const RenameBlock& edit) {
    if (!design.blocks.contains(edit.from)) return unknown_block(edit.from);
    if (Status fine = check_block_name(edit.to); !fine) return std::move(fine).error();
    if (edit.from == edit.to) return Edit(edit);
    if (design.blocks.contains(edit.to)) return invalid("there is a block named '" + edit.to + "' already");
    auto moved = design.blocks.extract(edit.from);
    moved.key() = edit.to;
    design.blocks.insert(std::move(moved));
    for (auto& [name, node] : design.blocks) node = with_renamed_children(node, {{edit.from, edit.to}});
    if (design.root == edit.from) design.root = edit.to;
    return Edit(RenameBlock{edit.to, edit.from});
}

Result<Edit> make(Design& design, const SetRoot& edit) {
    if (!design.blocks.contains(edit.name)) return unknown_block(edit.name);
    return Edit(SetRoot{std::exchange(design.root, edit.name)});
}

/// Undoing restores the node itself, so that the order of its flips comes back as well.
Result<Edit> make(Design& design, const PutFlip& edit) {
    const auto found = design.blocks.find(edit.block);
    if (found == design.blocks.end()) return unknown_block(edit.block);
    constexpr auto most = static_cast<std::size_t>(most_yarn_number);
    if (edit.flip.pick > most || edit.flip.end > most)
        return invalid("no cloth has a crossing of pick " + std::to_string(edit.flip.pick + 1) + " and end " +
                       std::to_string(edit.flip.end + 1));
    std::vector<Flip> flips = found->second->flips;
    const auto same_place = [&](const Flip& flip) {
        return flip.pick == edit.flip.pick && flip.end == edit.flip.end;
    };
    // What takes it back tells of one flip where that is all there is to tell: whoever keeps a long list of undo keeps no copy
    // of all flips for each of them.
    Edit undo = RemoveFlip{edit.block, edit.flip.pick, edit.flip.end};
    // Flips are made one after the other: one taken out from under later ones could undo or revive those.
    if (!flips.empty() && same_place(flips.back())) {
        undo = PutFlip{edit.block, flips.back()};
        flips.pop_back();
    } else if (std::ranges::any_of(flips, same_place)) {
        undo = PutBlock{edit.block, found->second};
    }
    flips.push_back(edit.flip);
    found->second = with_flips(*found->second, std::move(flips));
    return undo;
}

Result<Edit> make(Design& design, const RemoveFlip& edit) {
    const auto found = design.blocks.find(edit.block);
    if (found == design.blocks.end()) return unknown_block(edit.block);
    std::vector<Flip> flips = found->second->flips;
    if (std::erase_if(
            flips, [&](const Flip& flip) { return flip.pick == edit.pick && flip.end == edit.end; }) == 0) {
        return invalid("'" + edit.block + "' has no flip at pick " + std::to_string(edit.pick + 1) +
                       " and end " + std::to_string(edit.end + 1));
    }
    Edit undo = PutBlock{edit.block, found->second};
    found->second = with_flips(*found->second, std::move(flips));
    return undo;
}

Result<Edit> make(Design& design, const SetTitle& edit) {
    WEAVE_CHECK_OK(check_texts(edit.title, edit.notes));
    Edit undo = SetTitle{design.title, design.notes};
    design.title = edit.title;
    design.notes = edit.notes;
    return undo;
}

/// Exchanges a section, and takes it back where the design would no longer be sound.
template <class Section>
Status exchange_section(Design& design, Section& current, Section wanted) {
    std::swap(current, wanted);
    Status fine = check(design);
    if (!fine) std::swap(current, wanted);
    return fine;
}

Result<Edit> make(Design& design, const SetWarp& edit) {
    Edit undo = SetWarp{design.warp};
    WEAVE_CHECK_OK(exchange_section(design, design.warp, edit.warp));
    return undo;
}

Result<Edit> make(Design& design, const SetWeft& edit) {
    Edit undo = SetWeft{design.weft};
    WEAVE_CHECK_OK(exchange_section(design, design.weft, edit.weft));
    return undo;
}

Result<Edit> make(Design& design, const SetScene& edit) {
    Edit undo = SetScene{design.scene};
    WEAVE_CHECK_OK(exchange_section(design, design.scene, edit.scene));
    return undo;
}

// The members of each edit in JSON, and back.

Json write(const PutBlock& edit) {
    return {{"name", edit.name}, {"node", to_json(*edit.node)}};
}
Json write(const RemoveBlock& edit) {
    return {{"name", edit.name}};
}
Json write(const RenameBlock& edit) {
    return {{"from", edit.from}, {"to", edit.to}};
}
Json write(const SetRoot& edit) {
    return {{"name", edit.name}};
}
Json write(const PutFlip& edit) {
    return {{"block", edit.block}, {"flip", to_json(edit.flip)}};
}
Json write(const RemoveFlip& edit) {
    return {{"block", edit.block}, {"pick", edit.pick}, {"end", edit.end}};
}
Json write(const SetTitle& edit) {
    return {{"title", edit.title}, {"notes", edit.notes}};
}
Json write(const SetWarp& edit) {
    return {{"warp", to_json(edit.warp)}};
}
Json write(const SetWeft& edit) {
    return {{"weft", to_json(edit.weft)}};
}
Json write(const SetScene& edit) {
    return {{"scene", to_json(edit.scene)}};
}

Result<Edit> read_put_block(JsonReader& reader) {
    PutBlock edit{reader.text("name"), nullptr};
    if (!reader.has("node")) reader.fail("is missing", "node");
    WEAVE_CHECK_OK(reader.status());
    Result<NodePtr> node = node_from_json(reader.raw("node"));
    if (!node) return std::move(node).error().under("node");
    edit.node = std::move(node).value();
    return Edit(std::move(edit));
}

Result<Edit> read_edit(std::size_t kind, JsonReader& reader) {
    const auto number = [&](const char* key) {
        return static_cast<std::size_t>(reader.integer(key, 0, most_yarn_number));
    };
    switch (kind) {
        case 0:
            return read_put_block(reader);
        case 1:
            return Edit(RemoveBlock{reader.text("name")});
        case 2:
            return Edit(RenameBlock{reader.text("from"), reader.text("to")});
        case 3:
            return Edit(SetRoot{reader.text("name")});
        case 4: {
            JsonReader flip = reader.object("flip");
            return Edit(PutFlip{reader.text("block"), flip_from_json(flip)});
        }
        case 5:
            return Edit(RemoveFlip{reader.text("block"), number("pick"), number("end")});
        case 6:
            return Edit(SetTitle{reader.text("title"), reader.text("notes")});
        case 7:
            return Edit(SetWarp{warp_from_json(reader.object("warp"))});
        case 8:
            return Edit(SetWeft{weft_from_json(reader.object("weft"))});
        default:
            return Edit(SetScene{scene_from_json(reader.object("scene"))});
    }
}

}  // namespace

Result<Edit> apply_edit(Design& design, const Edit& edit) {
    return std::visit([&](const auto& one) { return make(design, one); }, edit);
}

Json to_json(const Edit& edit) {
    Json json{{"edit", edit_names[edit.index()]}};
    json.update(std::visit([](const auto& one) { return write(one); }, edit));
    return json;
}

Result<Edit> edit_from_json(const Json& value) {
    JsonReader reader(value, "");
    const std::size_t kind = reader.choice("edit", edit_names);
    WEAVE_CHECK_OK(reader.status());
    WEAVE_TRY(Edit edit, read_edit(kind, reader));
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return edit;
}

}  // namespace weave
