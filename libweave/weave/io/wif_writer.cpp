#include <weave/core/file.hpp>
#include <weave/core/json.hpp>
#include <weave/io/raster.hpp>
#include <weave/io/wif.hpp>
#include <weave/io/wif_private.hpp>

#include <algorithm>
#include <map>
#include <unordered_map>

namespace weave {

namespace {

using namespace wif;

constexpr std::string_view line_end = "\r\n";

/// Each has up to three lines; what else the file says has a quarter of all.
constexpr std::size_t most_threads_together = (most_lines - most_lines / 4) / 3;
static_assert(most_threads_together <= most_threads);

/// The file as it grows, and the sections that it holds.
class Text {
  public:
    void section(const std::string& name) {
        m_contents += name + "=true\r\n";
        m_body += "\r\n[" + name + "]\r\n";
    }
    void line(std::string_view key, std::string_view value) {
        m_body.append(key).append("=").append(value).append(line_end);
    }
    void line(std::size_t key, std::string_view value) { line(std::to_string(key), value); }
    [[nodiscard]] std::string& body() { return m_body; }
    [[nodiscard]] const std::string& contents() const { return m_contents; }

  private:
    std::string m_contents, m_body;
};

/// Different columns of the card, each a shaft.
struct Shafts {
    std::vector<std::uint32_t> of_end;   ///< from 0
    std::vector<std::size_t> first_end;  ///< of each shaft an end on it
};

Shafts shafts_of(const CardImage& card) {
    const CardImage columns = card.transposed();
    std::unordered_map<std::string_view, std::uint32_t> numbers;
    Shafts shafts;
    for (std::size_t end = 0; end < card.ends(); ++end) {
        const auto bits = columns.row(end);
        const std::string_view key(reinterpret_cast<const char*>(bits.data()), bits.size());
        const auto [entry, is_new] = numbers.try_emplace(key, static_cast<std::uint32_t>(numbers.size()));
        if (is_new) shafts.first_end.push_back(end);
        shafts.of_end.push_back(entry->second);
    }
    return shafts;
}

/// Free text on one line: what would end the line becomes a blank.
std::string one_line(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return text;
}

/// A colour and a thickness in cm for each thread, as the plans give them.
struct ThreadLooks {
    std::vector<Colour> colours;
    std::vector<double> thickness_cm;
    double spacing_cm = 0;
};

ThreadLooks looks_of_ends(const WarpPlan& warp, std::size_t ends) {
    ThreadLooks looks;
    for (std::size_t end = 0; end < ends; ++end) {
        const YarnType& yarn = warp.yarns[warp.order.at(end)];
        const std::uint32_t colour = warp.colour_order.at(end);
        looks.colours.push_back(colour == 0 ? yarn.colour : warp.colours[colour - 1]);
        looks.thickness_cm.push_back(yarn.radius_mm / 5);
    }
    looks.spacing_cm = 1 / warp.density_ends_per_cm;
    return looks;
}

/// A pick without a feeder looks like the first one; of two feeders the first counts.
ThreadLooks looks_of_picks(const WeftPlan& weft, const Block& block) {
    ThreadLooks looks;
    for (std::size_t pick = 0; pick < block.picks(); ++pick) {
        const FeederSet& set = weft.feeder_order[pick % weft.feeder_order.size()];
        const YarnType& yarn = weft.yarns[weft.feeders[set.empty() ? 0 : set.front()].yarn];
        looks.colours.push_back(yarn.colour);
        looks.thickness_cm.push_back(yarn.radius_mm / 5);
    }
    looks.spacing_cm =
        static_cast<double>(block.rows()) / static_cast<double>(block.picks()) / weft.density_picks_per_cm;
    return looks;
}

using ColourNumbers = std::map<Colour, std::size_t>;

void write_system(Text& text, const std::string& name, const ThreadLooks& looks,
                  const ColourNumbers& numbers) {
    text.section(name);
    text.line("Threads", std::to_string(looks.colours.size()));
    text.line("Color", std::to_string(numbers.at(looks.colours.front())));
    text.line("Units", "centimeters");
    text.line("Spacing", ecmascript_number(looks.spacing_cm));
    text.line("Thickness", ecmascript_number(looks.thickness_cm.front()));
    const auto uneven = [](const auto& list) {
        return std::any_of(list.begin(), list.end(), [&](const auto& item) { return item != list.front(); });
    };
    if (uneven(looks.colours)) {
        text.section(name + " COLORS");
        for (std::size_t k = 0; k < looks.colours.size(); ++k)
            text.line(k + 1, std::to_string(numbers.at(looks.colours[k])));
    }
    if (uneven(looks.thickness_cm)) {
        text.section(name + " THICKNESS");
        for (std::size_t k = 0; k < looks.thickness_cm.size(); ++k)
            text.line(k + 1, ecmascript_number(looks.thickness_cm[k]));
    }
}

ColourNumbers write_palette(Text& text, const ThreadLooks& warp, const ThreadLooks& weft) {
    ColourNumbers numbers;
    std::vector<Colour> table;
    for (const ThreadLooks* looks : {&warp, &weft}) {
        for (const Colour colour : looks->colours) {
            if (numbers.try_emplace(colour, numbers.size() + 1).second) table.push_back(colour);
        }
    }
    text.section("COLOR PALETTE");
    text.line("Entries", std::to_string(table.size()));
    text.line("Form", "RGB");
    text.line("Range", "0,255");
    text.section("COLOR TABLE");
    for (std::size_t k = 0; k < table.size(); ++k) {
        text.line(k + 1, std::to_string(table[k].red) + "," + std::to_string(table[k].green) + "," +
                             std::to_string(table[k].blue));
    }
    return numbers;
}

void write_notes(Text& text, const std::string& notes) {
    if (notes.empty()) return;
    text.section("NOTES");
    std::size_t number = 1;
    for (std::size_t at = 0; at <= notes.size(); ++number) {
        const std::size_t end = std::min(notes.find('\n', at), notes.size());
        text.line(number, one_line(notes.substr(at, end - at)));
        at = end + 1;
    }
}

/// For each pick the shafts that rise; 0 where none does.
Status write_lift_plan(Text& text, const CardImage& card, const Shafts& shafts) {
    text.section("LIFTPLAN");
    for (std::size_t pick = 0; pick < card.picks(); ++pick) {
        std::string lifted;
        for (std::size_t shaft = 0; shaft < shafts.first_end.size(); ++shaft) {
            if (card.weft_over(pick, shafts.first_end[shaft])) continue;
            if (!lifted.empty()) lifted.push_back(',');
            lifted += std::to_string(shaft + 1);
        }
        text.line(pick + 1, lifted.empty() ? "0" : lifted);
        if (text.body().size() > default_file_limit / 2)
            return bad_input("the lift plan is too large for a WIF file; write a bitmap (.png, .tif) instead");
    }
    return {};
}

Status check_size(const Block& block, const CardImage& card) {
    if (block.picks() != card.picks() || block.ends() != card.ends())
        return invalid("the card image is not that of the block");
    if (card.picks() + card.ends() <= most_threads_together) return {};
    const bool fits_a_bitmap = std::max(card.picks(), card.ends()) <= longest_side;
    return bad_input("a card of " + std::to_string(card.picks()) + " picks and " + std::to_string(card.ends()) +
                     " ends is larger than the limit of a WIF file, " + std::to_string(most_threads_together) +
                     " together; write " + (fits_a_bitmap ? "a bitmap (.png, .tif)" : "a smaller repeat") +
                     " instead");
}

}  // namespace

Result<std::string> write_wif(const Design& design, const Block& block, const CardImage& card) {
    WEAVE_CHECK_OK(check(design));
    WEAVE_CHECK_OK(check_size(block, card));
    const Shafts shafts = shafts_of(card);
    const std::size_t count = shafts.first_end.size();
    if (count > most_shafts) return bad_input("lifts its ends in too many ways for a WIF file; write a bitmap (.png, .tif) instead");
    const ThreadLooks warp = looks_of_ends(design.warp, card.ends()),
                      weft = looks_of_picks(design.weft, block);
    Text text;
    const ColourNumbers numbers = write_palette(text, warp, weft);
    text.section("TEXT");
    text.line("Title", one_line(design.title));
    write_notes(text, design.notes);
    text.section("WEAVING");
    text.line("Shafts", std::to_string(count));
    text.line("Treadles", std::to_string(count));
    text.line("Rising Shed", "true");
    write_system(text, "WARP", warp, numbers);
    write_system(text, "WEFT", weft, numbers);
    text.section("THREADING");
    for (std::size_t end = 0; end < card.ends(); ++end)
        text.line(end + 1, std::to_string(shafts.of_end[end] + 1));
    WEAVE_CHECK_OK(write_lift_plan(text, card, shafts));
    std::string file =
        "[WIF]\r\nVersion=1.1\r\nDate=April 20, 1997\r\nDevelopers=wif@mhsoft.com\r\n"
        "Source Program=weave\r\n\r\n[CONTENTS]\r\n" +
        text.contents() + "PRIVATE WEAVE DESIGN=true\r\n" + text.body() + "\r\n";
    file += private_section(design, block, card, file);
    return file;
}

}  // namespace weave
