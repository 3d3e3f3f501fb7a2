#include <weave/io/wif_private.hpp>

#include <weave/core/sha256.hpp>
#include <weave/core/text.hpp>
#include <weave/design/plan_json.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>

namespace weave::wif {

namespace {

constexpr std::size_t piece_size = 200;

/// Hash of text whatever its line ends: CR does not count, as mailers and editors change it.
std::string text_hash(std::string_view text) {
    Sha256 hash;
    while (!text.empty()) {
        const std::size_t end = std::min(text.find('\r'), text.size());
        hash.add(text.substr(0, end));
        text.remove_prefix(std::min(end + 1, text.size()));
    }
    return hash.hex();
}

/// t or p: repeated whole, it must come out even.
Result<std::vector<std::uint32_t>> read_counts(const Section& section, std::string_view key,
                                               std::size_t threads) {
    const Entry* entry = section.find(key);
    if (entry == nullptr)
        return bad_input(shown(section.name) + " lacks '" + std::string(key) + "'", place(section.line));
    Result<Sequence> counts = parse_sequence(entry->value, static_cast<std::uint32_t>(threads) + 1);
    if (!counts) return bad_input("'" + std::string(key) + "' " + counts.error().message, place(entry->line));
    const std::size_t sum = std::accumulate(counts->once.begin(), counts->once.end(), std::size_t{0});
    if (sum == 0 || threads % sum != 0) {
        return bad_input("'" + std::string(key) + "' counts " + std::to_string(sum) +
                             ", which does not divide " + std::to_string(threads),
                         place(entry->line));
    }
    return std::move(counts->once);
}

/// The JSON behind the keys 1, 2, …, each with a piece in quotes.
Result<Json> read_pieces(const Section& section) {
    std::string text;
    std::size_t next = 1;
    for (const Entry& entry : section.entries) {
        if (entry.key != std::to_string(next)) continue;
        const std::string_view piece = entry.value;
        if (piece.size() < 2 || piece.front() != '"' || piece.back() != '"')
            return bad_input("is no piece of our section, which stands in quotes", place(entry.line));
        text += piece.substr(1, piece.size() - 2);
        ++next;
    }
    Result<Json> json = parse_json(text);
    if (!json)
        return bad_input("what stands here cannot be read: " + json.error().text(), place(section.line));
    return json;
}

Status read_plans_of_ours(const Section& section, Design& design) {
    WEAVE_TRY(const Json json, read_pieces(section));
    JsonReader reader(json, "");
    if (!reader.failed()) {
        design.title = reader.text("title", "", longest_title);
        design.notes = reader.text("notes", "", longest_notes);
        design.warp = warp_from_json(reader.object("warp"));
        design.weft = weft_from_json(reader.object("weft"));
        reader.no_others();
    }
    if (Status fine = reader.status(); !fine) {
        const Error& error = fine.error();
        return bad_input(error.text(), place(section.line));
    }
    return {};
}

/// A row or column without yarns leaves no trace on the card, and a card is not read with one.
Sequence woven_counts(const std::vector<std::uint32_t>& counts) {
    std::vector<std::uint32_t> woven;
    std::ranges::copy_if(counts, std::back_inserter(woven), [](std::uint32_t count) { return count > 0; });
    return {shortest_repeat(woven)};
}

bool says(const Section& section, std::string_view key, const std::string& value) {
    const Entry* entry = section.find(key);
    return entry != nullptr && entry->value == value;
}

}  // namespace

std::string private_section(const Design& design, const Block& block, const CardImage& card,
                            std::string_view before) {
    const Json json{{"title", design.title},
                    {"notes", design.notes},
                    {"warp", to_json(design.warp)},
                    {"weft", to_json(design.weft)}};
    const std::string text = json.dump(-1, ' ', true, Json::error_handler_t::replace);
    std::string section = shown(private_name) + "\r\nVersion=1\r\nCard SHA-256=" + card.sha256() +
                          "\r\nText SHA-256=" + text_hash(before) + "\r\n";
    section += "Picks of rows=" + to_text(woven_counts(block.t())) + "\r\n";
    section += "Ends of columns=" + to_text(woven_counts(block.p())) + "\r\n";
    for (std::size_t at = 0, k = 1; at < text.size(); at += piece_size, ++k)
        section += std::to_string(k) + "=\"" + text.substr(at, piece_size) + "\"\r\n";
    return section;
}

Status apply_private(std::string_view text, const File& file, Design& design, Warnings& warnings) {
    const Section* section = file.find(private_name);
    if (section == nullptr) return {};
    if (!says(*section, "version", "1")) {
        warnings.add(section->line,
                     shown(private_name) + " is of a version that this program does not know; not read");
        return {};
    }
    const CardLeaf& bare = std::get<CardLeaf>(design.blocks.at(design.root)->source);
    if (!says(*section, "card sha-256", bare.card->sha256())) {
        warnings.add(section->line, "the weave was changed since " + shown(private_name) +
                                        " was written, which is not read therefore");
        return {};
    }
    CardLeaf leaf{bare.card, {}, {}};
    WEAVE_TRY(leaf.t, read_counts(*section, "picks of rows", bare.card->picks()));
    WEAVE_TRY(leaf.p, read_counts(*section, "ends of columns", bare.card->ends()));
    if (!says(*section, "text sha-256", text_hash(text.substr(0, section->offset)))) {
        warnings.add(section->line,
                     "the file was changed since " + shown(private_name) +
                         " was written; only the picks of rows and ends of columns are read from it");
    } else {
        WEAVE_CHECK_OK(read_plans_of_ours(*section, design));
    }
    design.blocks[design.root] = std::make_shared<const Node>(Node{std::move(leaf), {}});
    // What our section says is read as it stands; that it fits together shows only now.
    if (const Status fits = check(design); !fits) return bad_input(fits.error().text(), place(section->line));
    return {};
}

}  // namespace weave::wif
