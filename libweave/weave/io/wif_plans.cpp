#include <weave/io/wif_plans.hpp>

#include <weave/core/text.hpp>
#include <weave/core/units.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <unordered_map>

namespace weave::wif {

namespace {

constexpr std::size_t most_feeders = 64;

/// COLOR PALETTE and COLOR TABLE.
struct Palette {
    std::optional<std::pair<double, double>> range;
    std::map<std::size_t, Colour> colours;
    std::int64_t shift = 0;  ///< to add to a colour that a thread names, to find it in the table

    [[nodiscard]] const Colour* find(std::size_t number) const {
        const auto found = colours.find(static_cast<std::size_t>(static_cast<std::int64_t>(number) + shift));
        return found == colours.end() ? nullptr : &found->second;
    }
};

/// What [WARP] or [WEFT] and their lists say of each thread.
struct Look {
    std::optional<std::uint32_t> colour;  ///< of threads that are not listed
    std::uint32_t colour_line = 0;
    std::optional<Colour> spelled_out;  ///< `Color=index,R,G,B` of older files
    std::vector<std::pair<std::size_t, std::uint32_t>> colours;
    std::vector<std::uint32_t> colour_lines;
    std::vector<double> thickness_mm;  ///< 0 where the file is silent
    double spacing_mm = 0;             ///< on average; 0 where the file is silent
};

/// Numbers of a `R,G,B` value.
Result<std::vector<std::uint32_t>> triple(const Entry& entry, std::size_t wanted) {
    WEAVE_TRY(auto numbers, whole_list(entry.value, entry.line, 0x7fffffff));
    if (numbers.size() == wanted) return numbers;
    return bad_input(in_quotes(entry.value) + " is not " + counted(wanted, "number") + " of a colour",
                     place(entry.line));
}

std::uint8_t scaled(double value, std::pair<double, double> range) {
    const double part = (value - range.first) / (range.second - range.first);
    return static_cast<std::uint8_t>(std::lround(std::clamp(part, 0.0, 1.0) * 255));
}

Colour colour_of(const std::vector<std::uint32_t>& numbers, std::size_t first,
                 std::pair<double, double> range) {
    return {scaled(numbers[first], range), scaled(numbers[first + 1], range),
            scaled(numbers[first + 2], range)};
}

/// Whether the palette is red, green and blue; a file that says otherwise keeps its weave and loses its
/// colours.
bool is_rgb(const Section* section, Warnings& warnings) {
    const Entry* form = section == nullptr ? nullptr : section->find("form");
    if (form == nullptr || normal(plain(form->value)) == "rgb") return true;
    warnings.add(form->line, "the palette is " + in_quotes(form->value) + ", not RGB; colours are not read");
    return false;
}

Status read_range(const Section* section, Palette& palette) {
    const Entry* entry = section == nullptr ? nullptr : section->find("range");
    if (entry == nullptr) return {};
    WEAVE_TRY(const auto ends, triple(*entry, 2));
    if (ends[0] >= ends[1])
        return bad_input("the range of the colours, " + in_quotes(entry->value) + ", does not rise",
                         place(entry->line));
    palette.range = {ends[0], ends[1]};
    return {};
}

/// Notes what is odd about the table as a whole.
Status judge_table(const Section* section, const Section* table, const Palette& palette, Warnings& warnings) {
    const Entry* entries = section == nullptr ? nullptr : section->find("entries");
    if (entries != nullptr) {
        WEAVE_TRY(const std::int64_t said, whole(*entries, 0, 0x7fffffff));
        const std::size_t listed = palette.colours.size();
        if (static_cast<std::size_t>(said) != listed) {
            warnings.add(entries->line, "[COLOR PALETTE] says " +
                                            counted(static_cast<std::size_t>(said), "colour") +
                                            ", but [COLOR TABLE] lists " + std::to_string(listed));
        }
    }
    if (table != nullptr && section == nullptr)
        warnings.add(table->line,
                     "[COLOR TABLE] has no [COLOR PALETTE] that gives its range; read as 0 to 255 or 999");
    return {};
}

Result<Palette> read_palette(const File& file, Warnings& warnings) {
    const Section *section = file.find("color palette"), *table = file.find("color table");
    Palette palette;
    if (!is_rgb(section, warnings)) return palette;
    WEAVE_CHECK_OK(read_range(section, palette));
    if (table != nullptr) {
        WEAVE_TRY(const auto lines, numbered(*table, warnings));
        std::vector<std::pair<std::size_t, std::vector<std::uint32_t>>> raw;
        std::uint32_t highest = 0;
        for (const auto& [number, entry] : lines) {
            if (number > 0x7fffffff) return bad_input("names no colour that a table has", place(entry.line));
            WEAVE_TRY(auto numbers, triple(entry, 3));
            const std::uint32_t brightest = *std::max_element(numbers.begin(), numbers.end());
            if (palette.range && brightest > palette.range->second)
                warnings.add(entry.line, in_quotes(entry.value) + " is beyond the range of the palette");
            highest = std::max(highest, brightest);
            raw.emplace_back(number, std::move(numbers));
        }
        if (section != nullptr && !palette.range && !raw.empty())
            warnings.add(section->line, "[COLOR PALETTE] does not say Range; read as 0 to " +
                                            std::string(highest > 255 ? "999" : "255"));
        if (!palette.range) palette.range = {0, highest > 255 ? 999 : 255};
        for (const auto& [number, numbers] : raw)
            palette.colours.emplace_hint(palette.colours.end(), number,
                                         colour_of(numbers, 0, *palette.range));
    }
    WEAVE_CHECK_OK(judge_table(section, table, palette, warnings));
    return palette;
}

/// `Color=` of [WARP] or [WEFT]: an index, in older files with the colour itself behind it.
Status read_default_colour(const Section& section, const Palette& palette, Look& look, Warnings& warnings) {
    const Entry* entry = section.find("color");
    if (entry == nullptr) return {};
    WEAVE_TRY(const auto numbers, whole_list(entry->value, entry->line, 0x7fffffff));
    if (numbers.size() != 1 && numbers.size() != 4)
        return bad_input(in_quotes(entry->value) + " is neither the number of a colour nor index,R,G,B",
                         place(entry->line));
    look.colour = numbers[0];
    look.colour_line = entry->line;
    if (numbers.size() == 1) return {};
    warnings.add(entry->line, "Color= spells its colour out, as older files do");
    const std::uint32_t highest = *std::max_element(numbers.begin() + 1, numbers.end());
    look.spelled_out =
        colour_of(numbers, 1, palette.range.value_or(std::pair(0.0, highest > 255 ? 999.0 : 255.0)));
    return {};
}

/// Millimetres of one unit of [WARP] or [WEFT]; 0 if the file does not say it.
Result<double> unit_mm(const Section& section) {
    const Entry* entry = section.find("units");
    if (entry == nullptr) return 0.0;
    const std::string word = normal(plain(entry->value));
    for (const char* cm : {"centimeters", "centimetres", "centimeter", "centimetre", "cm"}) {
        if (word == cm) return 10.0;
    }
    for (const char* inch : {"inches", "inch", "in"}) {
        if (word == inch) return 25.4;
    }
    for (const char* mm : {"millimeters", "millimetres", "mm"}) {
        if (word == mm) return 1.0;
    }
    if (word == "decipoints" || word == "decipoint") return 25.4 / 720;
    return bad_input(in_quotes(entry->value) + " is no unit: centimeters, inches or decipoints",
                     place(entry->line));
}

/// A measure in mm, or 0, with a warning, where it is of no use.
Result<double> measure(const Entry& entry, double unit, Warnings& warnings) {
    if (plain(entry.value).empty()) return 0.0;
    WEAVE_TRY(const double value, decimal(entry));
    const double mm = value * unit;
    if (mm >= 1e-3 && mm <= 200) return mm;
    if (unit > 0)
        warnings.add(entry.line, in_quotes(entry.value) + " is no size of a yarn or spacing; it is not used");
    return 0.0;
}

/// One of Thickness and Spacing: the default, and what the list says, in mm for each thread.
Result<std::vector<double>> read_measure(const File& file, const Section& section, const std::string& key,
                                         const Threads& threads, double unit, Warnings& warnings) {
    double standard = 0;
    std::size_t line = 0;
    if (const Entry* entry = section.find(key); entry != nullptr) {
        WEAVE_TRY(standard, measure(*entry, unit, warnings));
        line = entry->line;
    }
    std::vector<double> sizes(threads.count, standard);
    const Section* list = file.find(section.name + " " + key);
    if (list != nullptr) {
        WEAVE_TRY(const auto lines, per_thread(*list, threads, warnings));
        for (const auto& [thread, entry] : lines) {
            WEAVE_TRY(const double size, measure(entry, unit, warnings));
            if (size > 0) sizes[thread] = size;
            line = entry.line;
        }
    }
    if (unit == 0 && line > 0)
        warnings.add(line, shown(section.name) + " gives its " + key + " without Units, so it is not used");
    return sizes;
}

double mean_of_known(const std::vector<double>& sizes) {
    double sum = 0;
    std::size_t known = 0;
    for (const double size : sizes) {
        sum += size;
        known += size > 0 ? 1 : 0;
    }
    return known == 0 ? 0 : sum / static_cast<double>(known);
}

Result<Look> read_look(const File& file, const std::string& system, const Threads& threads,
                       const Palette& palette, Warnings& warnings) {
    Look look;
    Section none;
    none.name = system;
    const Section& section = file.find(system) == nullptr ? none : *file.find(system);
    WEAVE_CHECK_OK(read_default_colour(section, palette, look, warnings));
    WEAVE_TRY(const double unit, unit_mm(section));
    WEAVE_TRY(look.thickness_mm, read_measure(file, section, "thickness", threads, unit, warnings));
    WEAVE_TRY(const auto spacing, read_measure(file, section, "spacing", threads, unit, warnings));
    look.spacing_mm = mean_of_known(spacing);
    const Section* list = file.find(system + " colors");
    if (list == nullptr) return look;
    WEAVE_TRY(const auto lines, per_thread(*list, threads, warnings));
    for (const auto& [thread, entry] : lines) {
        if (plain(entry.value).empty()) continue;
        WEAVE_TRY(const std::int64_t number, whole(entry, 0, 0x7fffffff));
        look.colours.emplace_back(thread, static_cast<std::uint32_t>(number));
        look.colour_lines.push_back(entry.line);
    }
    return look;
}

/// Finds out whether threads and table count colours alike, and from where.
Status align(Palette& palette, const std::array<const Look*, 2>& looks, const File& file,
             Warnings& warnings) {
    std::uint32_t low = 0xffffffff, high = 0, low_line = 0;
    const auto note = [&](std::uint32_t colour, std::uint32_t line) {
        if (colour < low) low_line = line;
        low = std::min(low, colour);
        high = std::max(high, colour);
    };
    for (const Look* look : looks) {
        if (look->colour && !look->spelled_out) note(*look->colour, look->colour_line);
        for (std::size_t k = 0; k < look->colours.size(); ++k)
            note(look->colours[k].second, look->colour_lines[k]);
    }
    if (palette.colours.empty() || low > high) return {};
    const std::size_t first = palette.colours.begin()->first, last = palette.colours.rbegin()->first;
    if (first == 0) {
        warnings.add(file.find("color table")->line, "[COLOR TABLE] counts from 0; read as from 1");
        if (low > 0 && high == last + 1) palette.shift = -1;
    } else if (low == 0 && high < last) {
        warnings.add(low_line, "threads count their colours from 0; read as from 1");
        palette.shift = 1;
    } else if (low == 0) {
        return bad_input("names colour 0, but colours count from 1", place(low_line));
    }
    return {};
}

/// The colour of each thread.
std::vector<Colour> colours_of(const Look& look, const Palette& palette, const Threads& threads,
                               Colour standard, Warnings& warnings) {
    std::map<std::uint32_t, bool> missed;
    const auto find = [&](std::uint32_t number, std::uint32_t line) {
        if (const Colour* colour = palette.find(number)) return *colour;
        if (!std::exchange(missed[number], true))
            warnings.add(line, "colour " + std::to_string(number) + " is not in [COLOR TABLE]; " +
                                   to_text(standard) + " stands for it");
        return standard;
    };
    Colour unlisted = standard;
    if (look.spelled_out) {
        unlisted = *look.spelled_out;
    } else if (look.colour) {
        unlisted = find(*look.colour, look.colour_line);
    }
    if (!look.colour && !look.colours.empty() && look.colours.size() < threads.count) {
        warnings.add(look.colour_lines.front(), counted(threads.count - look.colours.size(), "thread") +
                                                    " of this section have no colour; " + to_text(standard) +
                                                    " stands for it");
    }
    std::vector<Colour> colours(threads.count, unlisted);
    for (std::size_t k = 0; k < look.colours.size(); ++k)
        colours[look.colours[k].first] = find(look.colours[k].second, look.colour_lines[k]);
    return colours;
}

/// Numbers different values in the order in which they first come.
template <class Value>
class Numbering {
  public:
    std::uint32_t number_of(const Value& value) {
        const auto [entry, is_new] =
            m_numbers.try_emplace(value, static_cast<std::uint32_t>(m_values.size()));
        if (is_new) m_values.push_back(value);
        return entry->second;
    }
    [[nodiscard]] const std::vector<Value>& values() const { return m_values; }

  private:
    std::map<Value, std::uint32_t> m_numbers;
    std::vector<Value> m_values;
};

Sequence short_form(std::vector<std::uint32_t> once) {
    if (std::all_of(once.begin(), once.end(), [&](std::uint32_t k) { return k == once[0]; })) once.resize(1);
    return {std::move(once)};
}

double density_of(double spacing_mm, double standard) {
    return spacing_mm == 0 ? standard : std::clamp(10 / spacing_mm, 0.01, 1e4);
}

void set_thickness(YarnType& yarn, double thickness_mm) {
    if (thickness_mm > 0) yarn.radius_mm = std::clamp(thickness_mm / 2, 1e-4, 100.0);
}

/// The colour that most ends have becomes the yarns' own, the others stand in `colours`.
void fill_warp(WarpPlan& warp, const Look& look, const std::vector<Colour>& colours) {
    std::map<Colour, std::size_t> counts;
    for (const Colour colour : colours) ++counts[colour];
    const Colour own = std::max_element(counts.begin(), counts.end(), [](const auto& a, const auto& b) {
                           return a.second < b.second;
                       })->first;
    Numbering<Colour> others;
    Numbering<double> sizes;
    std::vector<std::uint32_t> colour_order, order;
    for (std::size_t end = 0; end < colours.size(); ++end) {
        colour_order.push_back(colours[end] == own ? 0 : others.number_of(colours[end]) + 1);
        order.push_back(sizes.number_of(look.thickness_mm[end]));
    }
    const YarnType standard = warp.yarns.front();
    warp.yarns.clear();
    for (const double size : sizes.values()) {
        YarnType& yarn = warp.yarns.emplace_back(standard);
        yarn.name = sizes.values().size() == 1 ? "warp" : "warp " + std::to_string(warp.yarns.size());
        yarn.colour = own;
        set_thickness(yarn, size);
    }
    warp.order = short_form(std::move(order));
    warp.colours = others.values();
    warp.colour_order = short_form(std::move(colour_order));
    warp.density_ends_per_cm = density_of(look.spacing_mm, warp.density_ends_per_cm);
}

using WeftYarn = std::pair<Colour, double>;

/// The one of the first yarns that comes nearest in colour.
std::uint32_t nearest(const std::vector<WeftYarn>& yarns, Colour colour) {
    const auto distance = [&](const WeftYarn& yarn) {
        const int red = yarn.first.red - colour.red, green = yarn.first.green - colour.green;
        const int blue = yarn.first.blue - colour.blue;
        return red * red + green * green + blue * blue;
    };
    const auto end = yarns.begin() + static_cast<std::ptrdiff_t>(std::min(yarns.size(), most_feeders));
    const auto best = std::min_element(
        yarns.begin(), end, [&](const WeftYarn& a, const WeftYarn& b) { return distance(a) < distance(b); });
    return static_cast<std::uint32_t>(best - yarns.begin());
}

void fill_weft(WeftPlan& weft, const Look& look, const std::vector<Colour>& colours, Warnings& warnings) {
    Numbering<WeftYarn> yarns;
    std::vector<std::uint32_t> order;
    for (std::size_t pick = 0; pick < colours.size(); ++pick)
        order.push_back(yarns.number_of({colours[pick], look.thickness_mm[pick]}));
    const std::vector<WeftYarn>& all = yarns.values();
    std::vector<std::uint32_t> feeder_of;
    for (std::uint32_t k = 0; k < all.size(); ++k)
        feeder_of.push_back(k < most_feeders ? k : nearest(all, all[k].first));
    if (all.size() > most_feeders) {
        warnings.add("the picks use " + std::to_string(all.size()) +
                     " different yarns, but a design has at most " + std::to_string(most_feeders) +
                     " feeders; the others come from the feeder of the nearest colour");
    }
    const YarnType standard = weft.yarns.front();
    weft.yarns.clear();
    weft.feeders.clear();
    weft.feeder_order.clear();
    for (std::uint32_t k = 0; k < std::min(all.size(), most_feeders); ++k) {
        YarnType& yarn = weft.yarns.emplace_back(standard);
        yarn.name = "weft " + std::to_string(k + 1);
        yarn.colour = all[k].first;
        set_thickness(yarn, all[k].second);
        weft.feeders.push_back({"shuttle " + std::to_string(k + 1), k});
    }
    for (const std::uint32_t feeder : short_form(std::move(order)).once)
        weft.feeder_order.push_back({feeder_of[feeder]});
    weft.density_picks_per_cm = density_of(look.spacing_mm, weft.density_picks_per_cm);
}

}  // namespace

Result<Plans> read_plans(const File& file, const Threads& ends, const Threads& picks, Warnings& warnings) {
    Plans plans;
    WEAVE_TRY(Palette palette, read_palette(file, warnings));
    WEAVE_TRY(const Look warp, read_look(file, "warp", ends, palette, warnings));
    WEAVE_TRY(const Look weft, read_look(file, "weft", picks, palette, warnings));
    WEAVE_CHECK_OK(align(palette, {&warp, &weft}, file, warnings));
    fill_warp(plans.warp, warp, colours_of(warp, palette, ends, plans.warp.yarns[0].colour, warnings));
    fill_weft(plans.weft, weft, colours_of(weft, palette, picks, plans.weft.yarns[0].colour, warnings),
              warnings);
    return plans;
}

}  // namespace weave::wif
