#include <weave/design/node_json.hpp>

#include <weave/core/text.hpp>
#include <weave/design/plan_json.hpp>

#include <algorithm>

namespace weave {

namespace {

const std::vector<std::string> kinds{"stacks", "card",   "preset",  "slice",
                                     "tile",   "attach", "stencil", "renumber"};
const std::vector<std::string> system_names{"warp", "weft"};
const std::vector<std::string> side_names{"under", "over"};

Error in_list(Error error, const std::string& list, std::size_t i, std::optional<std::size_t> j = {}) {
    error.where = j ? indexed(indexed(list, i), *j) : indexed(list, i);
    return error;
}

// ---- stacks

Json write(const StacksLeaf& leaf) {
    const Block& block = *leaf.block;
    Json rows = Json::array();
    for (std::size_t i = 0; i < block.rows(); ++i) {
        Json row = Json::array();
        for (std::size_t j = 0; j < block.columns(); ++j) {
            row.push_back(to_text(block.stack(i, j), block.first_pick(i), block.first_end(j)));
        }
        rows.push_back(std::move(row));
    }
    return {{"height", block.height()}, {"stacks", std::move(rows)}};
}

/// The text of one stack, checked to be one.
Result<std::string> stack_text(const Json& rows, std::size_t i, std::size_t j) {
    const Json& text = rows[i][j];
    if (!text.is_string()) return in_list(bad_input("must be a text such as 'T0 P1 P0 -'"), "stacks", i, j);
    return text.get<std::string>();
}

Result<std::vector<std::uint32_t>> count_yarns(const Json& rows, System system) {
    const std::size_t lines = system == System::weft ? rows.size() : rows[0].size();
    std::vector<std::uint32_t> counts;
    for (std::size_t k = 0; k < lines; ++k) {
        WEAVE_TRY(const std::string text,
                  system == System::weft ? stack_text(rows, k, 0) : stack_text(rows, 0, k));
        counts.push_back(static_cast<std::uint32_t>(
            std::count(text.begin(), text.end(), system == System::weft ? 'T' : 'P')));
    }
    return counts;
}

/// How many places a stack has as it is written, empty ones on top included.
std::size_t places_in(std::string_view text) {
    std::size_t places = 0;
    bool between = true;
    for (const char c : text) {
        const bool space = c == ' ' || c == '\t';
        if (between && !space) ++places;
        between = space;
    }
    return places;
}

Result<NodeSource> read_stacks(JsonReader& reader) {
    const Json& rows = reader.raw("stacks");
    auto height = static_cast<std::size_t>(reader.integer("height", 0, most_height, 0));
    WEAVE_CHECK_OK(reader.status());
    if (!rows.is_array() || rows.empty())
        return bad_input("must be a list of rows, each a list of stacks", "stacks");
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].is_array() || rows[i].empty())
            return in_list(bad_input("must be a list of stacks"), "stacks", i);
        if (rows[i].size() != rows[0].size()) {
            return in_list(bad_input("has " + std::to_string(rows[i].size()) + " stacks, but row 0 has " +
                                     std::to_string(rows[0].size())),
                           "stacks", i);
        }
    }
    WEAVE_TRY(std::vector<std::uint32_t> t, count_yarns(rows, System::weft));
    WEAVE_TRY(std::vector<std::uint32_t> p, count_yarns(rows, System::warp));
    StackTable table;
    std::vector<std::uint32_t> cells;
    std::size_t first_pick = 0;
    for (std::size_t i = 0; i < t.size(); first_pick += t[i++]) {
        std::size_t first_end = 0;
        for (std::size_t j = 0; j < p.size(); first_end += p[j++]) {
            WEAVE_TRY(const std::string text, stack_text(rows, i, j));
            Result<Stack> stack = parse_stack(text, first_pick, first_end);
            if (!stack) return in_list(std::move(stack).error(), "stacks", i, j);
            height = std::max(height, places_in(text));
            cells.push_back(table.number_of(std::move(stack).value()));
        }
    }
    WEAVE_TRY(Block block,
              Block::make(std::move(t), std::move(p), std::move(table).take(), std::move(cells), height));
    return NodeSource(StacksLeaf{std::make_shared<const Block>(std::move(block))});
}

// ---- card

std::string hex(std::span<const std::uint8_t> bytes) {
    constexpr char digits[] = "0123456789abcdef";
    std::string text;
    text.reserve(bytes.size() * 2);
    for (const std::uint8_t byte : bytes) {
        text.push_back(digits[byte >> 4]);
        text.push_back(digits[byte & 15]);
    }
    return text;
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    return -1;
}

Json write(const CardLeaf& leaf) {
    Json rows = Json::array();
    for (std::size_t pick = 0; pick < leaf.card->picks(); ++pick) rows.push_back(hex(leaf.card->row(pick)));
    return {{"ends", leaf.card->ends()}, {"t", leaf.t}, {"p", leaf.p}, {"card", std::move(rows)}};
}

Status read_card_row(CardImage& card, std::size_t pick, const Json& text) {
    const auto row = card.row(pick);
    const std::string digits = text.is_string() ? text.get<std::string>() : "";
    bool fine = digits.size() == row.size() * 2;
    for (std::size_t k = 0; fine && k < row.size(); ++k) {
        const int high = hex_digit(digits[2 * k]), low = hex_digit(digits[2 * k + 1]);
        fine = high >= 0 && low >= 0;
        row[k] = static_cast<std::uint8_t>(high * 16 + low);
    }
    const std::size_t padding = row.size() * 8 - card.ends();
    fine = fine && (row.back() & ((1 << padding) - 1)) == 0;
    if (fine) return {};
    return bad_input("must be " + std::to_string(row.size() * 2) +
                     " lower-case hexadecimal digits that stand for " + std::to_string(card.ends()) +
                     " ends, the padding 0");
}

std::vector<std::uint32_t> counts_member(JsonReader& reader, const std::string& key) {
    if (!reader.has(key)) return {1};
    std::vector<std::uint32_t> counts;
    for (const std::int64_t count : reader.integers(key, 0, most_yarn_number)) {
        counts.push_back(static_cast<std::uint32_t>(count));
    }
    if (counts.empty()) reader.fail("needs at least one number", key);
    return counts;
}

Result<NodeSource> read_card(JsonReader& reader) {
    const auto ends = static_cast<std::size_t>(reader.integer("ends", 1, most_yarn_number));
    CardLeaf leaf{nullptr, counts_member(reader, "t"), counts_member(reader, "p")};
    const Json& rows = reader.raw("card");
    WEAVE_CHECK_OK(reader.status());
    if (!rows.is_array() || rows.empty()) return bad_input("must be a list of rows, pick 1 first", "card");
    if (Status fits = check_card_size(rows.size(), ends); !fits) return std::move(fits).error().in("card");
    if (!rows[0].is_string() || rows[0].get_ref<const std::string&>().size() != (ends + 7) / 8 * 2) {
        return in_list(bad_input("must have two hexadecimal digits for each 8 ends"), "card", 0);
    }
    CardImage card(rows.size(), ends);
    for (std::size_t pick = 0; pick < rows.size(); ++pick) {
        if (Status fine = read_card_row(card, pick, rows[pick]); !fine)
            return in_list(std::move(fine).error(), "card", pick);
    }
    leaf.card = std::make_shared<const CardImage>(std::move(card));
    return NodeSource(std::move(leaf));
}

// ---- preset and slice

Json write(const PresetLeaf& leaf) {
    Json options = Json::object();
    for (const auto& [name, value] : leaf.preset.options) options[name] = value;
    return {{"family", leaf.preset.family}, {"options", std::move(options)}};
}

Result<NodeSource> read_preset(JsonReader& reader) {
    Preset preset{reader.text("family", {}, longest_family), {}};
    JsonReader options = reader.object("options", true);
    for (auto it = options.json().begin(); it != options.json().end(); ++it) {
        preset.options[it.key()] = options.integer(it.key(), -most_option, most_option);
    }
    WEAVE_CHECK_OK(reader.status());
    return NodeSource(PresetLeaf{std::move(preset)});
}

Json write(const SliceLeaf& leaf) {
    Json positions = Json::array();
    for (const auto& position : leaf.slice.positions) positions.push_back(to_text(position));
    return {{"dots", system_names[static_cast<std::size_t>(leaf.slice.dots)]},
            {"positions", std::move(positions)}};
}

Result<NodeSource> read_slice(JsonReader& reader) {
    Slice slice{static_cast<System>(reader.choice("dots", system_names)), {}};
    const Json& positions = reader.raw("positions");
    WEAVE_CHECK_OK(reader.status());
    if (!positions.is_array())
        return bad_input("must be a list of texts such as 'T0 P0 (T1) P1'", "positions");
    for (std::size_t k = 0; k < positions.size(); ++k) {
        if (!positions[k].is_string())
            return in_list(bad_input("must be a text such as 'T0 P0 (T1) P1'"), "positions", k);
        auto position = parse_slice_position(positions[k].get_ref<const std::string&>());
        if (!position) return in_list(std::move(position).error(), "positions", k);
        slice.positions.push_back(std::move(position).value());
    }
    return NodeSource(SliceLeaf{std::move(slice)});
}

// ---- operations

Json write(const TileOperation& tile) {
    return {{"of", tile.of}, {"x", tile.x}, {"y", tile.y}, {"z", tile.z}};
}

Result<NodeSource> read_tile(JsonReader& reader) {
    TileOperation tile;
    tile.of = reader.text("of");
    tile.x = static_cast<std::size_t>(reader.integer("x", 1, static_cast<std::int64_t>(most_times), 1));
    tile.y = static_cast<std::size_t>(reader.integer("y", 1, static_cast<std::int64_t>(most_times), 1));
    tile.z = static_cast<std::size_t>(reader.integer("z", 1, static_cast<std::int64_t>(most_times), 1));
    WEAVE_CHECK_OK(reader.status());
    return NodeSource(std::move(tile));
}

Json write(const AttachOperation& attach) {
    return {{"of", attach.of},
            {"other", attach.other},
            {"face", face_names()[static_cast<std::size_t>(attach.face)]}};
}

Result<NodeSource> read_attach(JsonReader& reader) {
    AttachOperation attach{reader.text("of"), reader.text("other"),
                           static_cast<Face>(reader.choice("face", face_names()))};
    WEAVE_CHECK_OK(reader.status());
    return NodeSource(std::move(attach));
}

Json write(const StencilOperation& stencil) {
    Json rows = Json::array();
    for (std::size_t i = 0; i < stencil.map->rows; ++i) {
        const auto row = stencil.map->row(i);
        rows.push_back(to_text(Sequence{{row.begin(), row.end()}}));
    }
    return {{"of", stencil.of}, {"map", std::move(rows)}};
}

Result<NodeSource> read_stencil(JsonReader& reader) {
    const Json& of = reader.raw("of");
    const Json& rows = reader.raw("map");
    StencilOperation stencil;
    if (!of.is_array() || of.empty() || of.size() > most_stencilled)
        return bad_input("must be a list of 1 to " + std::to_string(most_stencilled) + " block names", "of");
    for (std::size_t k = 0; k < of.size(); ++k) {
        if (!of[k].is_string()) return in_list(bad_input("must be a block name"), "of", k);
        stencil.of.push_back(of[k].get<std::string>());
    }
    if (!rows.is_array() || rows.empty())
        return bad_input("must be a list of rows such as '0*12 1*3', bottom row first", "map");
    StencilMap map;
    map.rows = rows.size();
    for (std::size_t i = 0; i < rows.size(); ++i) {
        if (!rows[i].is_string()) return in_list(bad_input("must be a text such as '0*12 1*3'"), "map", i);
        auto row =
            parse_sequence(rows[i].get_ref<const std::string&>(), static_cast<std::uint32_t>(of.size()));
        if (!row) return in_list(std::move(row).error(), "map", i);
        if (i == 0) map.columns = row->once.size();
        if (row->once.size() != map.columns) {
            return in_list(bad_input("has " + std::to_string(row->once.size()) + " stacks, but row 0 has " +
                                     std::to_string(map.columns)),
                           "map", i);
        }
        if (Status fits = check_card_size(map.rows, map.columns); !fits)
            return std::move(fits).error().in("map");
        map.blocks.insert(map.blocks.end(), row->once.begin(), row->once.end());
    }
    stencil.map = std::make_shared<const StencilMap>(std::move(map));
    return NodeSource(std::move(stencil));
}

Json write(const RenumberOperation& renumber) {
    return {{"of", renumber.of},
            {renumber.system == System::weft ? "row" : "column", renumber.line},
            {"order", renumber.order}};
}

Result<NodeSource> read_renumber(JsonReader& reader) {
    RenumberOperation renumber;
    renumber.of = reader.text("of");
    if (reader.has("row") == reader.has("column")) reader.fail("needs either a row or a column");
    renumber.system = reader.has("row") ? System::weft : System::warp;
    renumber.line =
        static_cast<std::size_t>(reader.integer(reader.has("row") ? "row" : "column", 0, most_yarn_number));
    for (const std::int64_t number : reader.integers("order", 0, most_yarn_number)) {
        renumber.order.push_back(static_cast<std::size_t>(number));
    }
    WEAVE_CHECK_OK(reader.status());
    return NodeSource(std::move(renumber));
}

Result<NodeSource> read_source(std::size_t kind, JsonReader& reader) {
    switch (kind) {
        case 0:
            return read_stacks(reader);
        case 1:
            return read_card(reader);
        case 2:
            return read_preset(reader);
        case 3:
            return read_slice(reader);
        case 4:
            return read_tile(reader);
        case 5:
            return read_attach(reader);
        case 6:
            return read_stencil(reader);
        default:
            return read_renumber(reader);
    }
}

}  // namespace

Json to_json(const Flip& flip) {
    return {{"pick", flip.pick}, {"end", flip.end}, {"weft", side_names[flip.weft_over ? 1 : 0]}};
}

Flip flip_from_json(JsonReader& reader) {
    Flip flip;
    flip.pick = static_cast<std::size_t>(reader.integer("pick", 0, most_yarn_number));
    flip.end = static_cast<std::size_t>(reader.integer("end", 0, most_yarn_number));
    flip.weft_over = reader.choice("weft", side_names) == 1;
    reader.no_others();
    return flip;
}

Json to_json(const Node& node) {
    Json json{{"kind", kinds[node.source.index()]}};
    json.update(std::visit([](const auto& source) { return write(source); }, node.source));
    if (!node.flips.empty()) {
        Json& flips = json["flips"] = Json::array();
        for (const Flip& flip : node.flips) flips.push_back(to_json(flip));
    }
    return json;
}

Result<NodePtr> node_from_json(const Json& value) {
    JsonReader reader(value, "");
    const std::size_t kind = reader.choice("kind", kinds);
    std::vector<Flip> flips;
    for (JsonReader& item : reader.objects("flips", true)) flips.push_back(flip_from_json(item));
    WEAVE_CHECK_OK(reader.status());
    WEAVE_TRY(NodeSource source, read_source(kind, reader));
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    return std::make_shared<const Node>(Node{std::move(source), std::move(flips)});
}

}  // namespace weave
