#include <weave/sim/yarns_file.hpp>

#include <weave/core/json_reader.hpp>
#include <weave/core/text.hpp>
#include <weave/sim/yarns_checks.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>

namespace weave {

using namespace yarns_detail;

namespace {

constexpr std::string_view magic = "weave-yarns ";
constexpr std::size_t longest_line = 32;  ///< of the two lines before the header
constexpr std::size_t point_bytes = 24, number_bytes = 8, crossing_words = 7,
                      crossing_bytes = 4 * crossing_words;
constexpr std::size_t longest_title = 1000;
constexpr double smallest_radius_mm = 1e-9;
const std::vector<std::string> system_names{"weft", "warp"};

// ---- Header ----

Json vector_json(const Vec3& vector) {
    return Json::array({vector.x(), vector.y(), vector.z()});
}

Json yarn_json(const SimulatedYarn& yarn, std::size_t points) {
    Json json{{"system", system_names[yarn.system == System::warp ? 1 : 0]},
              {"number", yarn.number},
              {"beam", yarn.beam},
              {"radius_mm", yarn.radius_mm},
              {"colour", to_text(yarn.colour)},
              {"points", points},
              {"periodic", yarn.spline.is_periodic}};
    if (yarn.spline.is_periodic) json["shift_mm"] = vector_json(yarn.spline.shift);
    json["planned_length_mm"] = yarn.planned_length_mm;
    json["length_mm"] = yarn.length_mm;
    json["rest_length_mm"] = yarn.rest_length_mm;
    return json;
}

struct ArrayPlace {
    const char* name;
    const char* type;
    std::size_t width, count;  ///< numbers of one item, and items
    [[nodiscard]] std::size_t bytes() const { return width * count * (type[0] == 'f' ? 8 : 4); }
};

/// The arrays behind the header, in their order; each begins where the one before it ends.
std::vector<ArrayPlace> array_table(std::size_t points, std::size_t crossings) {
    return {{"control", "f64", 3, points},
            {"planned", "f64", 3, points},
            {"strain", "f64", 1, points},
            {"contact_N", "f64", 1, points},
            {"crossings", "u32", crossing_words, crossings}};
}

Json table_json(std::size_t points, std::size_t crossings) {
    Json table = Json::array();
    std::size_t offset = 0;
    for (const ArrayPlace& array : array_table(points, crossings)) {
        table.push_back({{"name", array.name},
                         {"type", array.type},
                         {"width", array.width},
                         {"count", array.count},
                         {"offset", offset}});
        offset += array.bytes();
    }
    return table;
}

std::vector<std::size_t> points_of(const Yarns& yarns) {
    std::vector<std::size_t> points;
    for (const SimulatedYarn& yarn : yarns.yarns) points.push_back(yarn.spline.control.size());
    return points;
}

/// `points` of each yarn, whatever it has.
Json header_json(const Yarns& yarns, const std::vector<std::size_t>& points, std::size_t crossings) {
    Json json{{"title", yarns.title},
              {"design_sha256", yarns.design_sha256},
              {"scene_sha256", yarns.scene_sha256},
              {"size_mm", Json::array({yarns.size_mm[0], yarns.size_mm[1]})},
              {"periodic", Json::array({yarns.is_periodic[0], yarns.is_periodic[1]})},
              {"region",
               {{"first_row", yarns.region.first_row},
                {"last_row", yarns.region.last_row},
                {"first_column", yarns.region.first_column},
                {"last_column", yarns.region.last_column}}},
              {"cloth_rows", yarns.cloth_rows},
              {"cloth_columns", yarns.cloth_columns}};
    Json list = Json::array();
    for (std::size_t i = 0; i < yarns.yarns.size(); ++i) list.push_back(yarn_json(yarns.yarns[i], points[i]));
    json["yarns"] = std::move(list);
    json["report"] = yarns.report;
    json["arrays"] = table_json(std::accumulate(points.begin(), points.end(), std::size_t{0}), crossings);
    return json;
}

/// A list of `Count` members that `fits`, as `read` gives them.
template <std::size_t Count, class Value, class Fits>
std::array<Value, Count> fixed_list(JsonReader& reader, const std::string& key, const char* wish, Fits fits) {
    std::array<Value, Count> values{};
    const Json& list = reader.raw(key);
    if (!list.is_array() || list.size() != Count || !std::ranges::all_of(list, fits)) {
        reader.fail(std::string("must be a list of ") + wish, key);
        return values;
    }
    for (std::size_t i = 0; i < Count; ++i) values[i] = list[i].template get<Value>();
    return values;
}

bool is_coordinate(const Json& json) {
    return json.is_number() && std::abs(json.get<double>()) <= farthest_place_mm;
}
bool is_length(const Json& json) {
    return is_coordinate(json) && json.get<double>() >= 0;
}

SimulatedYarn read_yarn(JsonReader& reader, std::size_t& points) {
    SimulatedYarn yarn;
    const Range length{0, farthest_place_mm};
    yarn.system = reader.choice("system", system_names) == 1 ? System::warp : System::weft;
    yarn.number = static_cast<std::size_t>(reader.integer("number", 0, most_yarn_number));
    yarn.beam =
        static_cast<std::uint32_t>(reader.integer("beam", 0, std::numeric_limits<std::uint32_t>::max()));
    yarn.radius_mm = reader.number("radius_mm", {smallest_radius_mm, farthest_place_mm});
    yarn.colour = reader.colour("colour");
    yarn.spline.is_periodic = reader.boolean("periodic");
    points = static_cast<std::size_t>(reader.integer("points", yarn.spline.is_periodic ? 1 : 2,
                                                     static_cast<std::int64_t>(most_file_points)));
    if (yarn.spline.is_periodic) {
        const auto shift =
            fixed_list<3, double>(reader, "shift_mm", "three coordinates in mm", is_coordinate);
        yarn.spline.shift = {shift[0], shift[1], shift[2]};
    }
    yarn.planned_length_mm = reader.number("planned_length_mm", length);
    yarn.length_mm = reader.number("length_mm", length);
    yarn.rest_length_mm = reader.number("rest_length_mm", length);
    reader.no_others();
    return yarn;
}

struct Header {
    Yarns yarns;
    std::vector<std::size_t> points;  ///< of each yarn
    std::size_t all_points = 0, crossings = 0;
};

void read_yarn_list(JsonReader& reader, Header& header) {
    const Json& list = reader.json().contains("yarns") ? reader.json().at("yarns") : reader.json();
    if (list.is_array() && list.size() > most_file_yarns)
        return reader.fail("has more than " + std::to_string(most_file_yarns) + " yarns", "yarns");
    for (JsonReader& item : reader.objects("yarns")) {
        std::size_t points = 0;
        header.yarns.yarns.push_back(read_yarn(item, points));
        header.points.push_back(points);
        header.all_points += points;
        if (header.all_points > most_file_points)
            return reader.fail("have more than " + std::to_string(most_file_points) + " control points",
                               "yarns");
    }
}

void read_table(JsonReader& reader, Header& header) {
    std::vector<JsonReader> items = reader.objects("arrays");
    if (!items.empty())
        header.crossings = static_cast<std::size_t>(
            JsonReader(items.back()).integer("count", 0, static_cast<std::int64_t>(most_file_crossings)));
    if (!reader.failed() && reader.raw("arrays") != table_json(header.all_points, header.crossings))
        reader.fail("is not the table of arrays that these yarns need", "arrays");
}

Region read_region(JsonReader reader) {
    const auto number = [&](const char* key) {
        return static_cast<std::size_t>(reader.integer(key, 0, most_yarn_number));
    };
    Region region{number("first_row"), number("last_row"), number("first_column"), number("last_column")};
    if (region.first_row > region.last_row || region.first_column > region.last_column)
        reader.fail("ends before it begins");
    reader.no_others();
    return region;
}

Result<Header> read_header(std::string_view text) {
    WEAVE_TRY(const Json json, parse_json(text));
    JsonReader reader(json, "");
    Header header;
    Yarns& yarns = header.yarns;
    yarns.title = reader.text("title", {}, longest_title);
    yarns.design_sha256 = reader.text("design_sha256", {}, 64);
    yarns.scene_sha256 = reader.text("scene_sha256", {}, 64);
    yarns.size_mm = fixed_list<2, double>(reader, "size_mm", "two lengths in mm", is_length);
    yarns.is_periodic = fixed_list<2, bool>(reader, "periodic", "two of true and false",
                                            [](const Json& item) { return item.is_boolean(); });
    yarns.region = read_region(reader.object("region"));
    yarns.cloth_rows = static_cast<std::size_t>(reader.integer("cloth_rows", 0, most_yarn_number));
    yarns.cloth_columns = static_cast<std::size_t>(reader.integer("cloth_columns", 0, most_yarn_number));
    read_yarn_list(reader, header);
    yarns.report = reader.raw("report");
    if (!yarns.report.is_object()) reader.fail("must be an object", "report");
    read_table(reader, header);
    reader.no_others();
    WEAVE_CHECK_OK(reader.status());
    WEAVE_CHECK_OK(check_hash(yarns.design_sha256, "design_sha256"));
    WEAVE_CHECK_OK(check_hash(yarns.scene_sha256, "scene_sha256"));
    WEAVE_CHECK_OK(check_periods(yarns));
    WEAVE_CHECK_OK(check_numbers(yarns));
    WEAVE_CHECK_OK(check_report(yarns.report));
    return header;
}

// ---- Arrays ----

template <class Word>
Word little_endian(Word word) {
    if constexpr (std::endian::native == std::endian::little) return word;
    Word turned = 0;
    for (std::size_t i = 0; i < sizeof(Word); ++i) turned = turned << 8 | (word >> 8 * i & 0xff);
    return turned;
}

void append_word(std::string& bytes, std::uint32_t word) {
    word = little_endian(word);
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

void append_number(std::string& bytes, double number) {
    const auto word = little_endian(std::bit_cast<std::uint64_t>(number));
    bytes.append(reinterpret_cast<const char*>(&word), sizeof word);
}

void append_points(std::string& bytes, const std::vector<Vec3>& points) {
    for (const Vec3& point : points) {
        for (int axis = 0; axis < 3; ++axis) append_number(bytes, point[axis]);
    }
}

/// Takes numbers from the front of bytes whose size was checked.
class Taker {
  public:
    explicit Taker(std::string_view bytes) : m_bytes(bytes) {}
    std::uint32_t word() { return little_endian(take<std::uint32_t>()); }
    double number() { return std::bit_cast<double>(little_endian(take<std::uint64_t>())); }
    Vec3 point() {
        const double x = number(), y = number();
        return {x, y, number()};
    }

  private:
    template <class Word>
    Word take() {
        Word word;
        std::memcpy(&word, m_bytes.data(), sizeof word);
        m_bytes.remove_prefix(sizeof word);
        return word;
    }
    std::string_view m_bytes;
};

void read_points(Header& header, Taker& taker) {
    auto& yarns = header.yarns.yarns;
    const auto fill = [&](auto member, auto take) {
        for (std::size_t i = 0; i < yarns.size(); ++i) {
            auto& list = member(yarns[i]);
            list.resize(header.points[i]);
            for (auto& item : list) item = take();
        }
    };
    const auto point = [&] { return taker.point(); };
    const auto number = [&] { return taker.number(); };
    fill(
        [](SimulatedYarn & yarn) -> auto& { return yarn.spline.control; }, point);
    fill(
        [](SimulatedYarn & yarn) -> auto& { return yarn.planned; }, point);
    fill(
        [](SimulatedYarn & yarn) -> auto& { return yarn.strain; }, number);
    fill(
        [](SimulatedYarn & yarn) -> auto& { return yarn.contact_N; }, number);
}

Status read_crossings(Header& header, Taker& taker) {
    header.yarns.crossings.resize(header.crossings);
    for (std::size_t i = 0; i < header.crossings; ++i) {
        Crossing& crossing = header.yarns.crossings[i];
        for (std::size_t* index : {&crossing.weft, &crossing.weft_key, &crossing.warp, &crossing.warp_key,
                                   &crossing.pick, &crossing.end}) {
            *index = taker.word();
        }
        const std::uint32_t over = taker.word();
        if (over > 1)
            return bad_input("says neither 0 nor 1 of which yarn is above",
                             "crossings[" + std::to_string(i) + "]");
        crossing.weft_over = over == 1;
    }
    return check_crossings(header.yarns);
}

/// The line at the front, without its end, which is taken away; nothing where it does not end soon.
std::optional<std::string_view> take_line(std::string_view& bytes) {
    const std::size_t end = bytes.substr(0, longest_line).find('\n');
    if (end == std::string_view::npos) return {};
    const std::string_view line = bytes.substr(0, end);
    bytes.remove_prefix(end + 1);
    return line;
}

/// A whole number as the writer writes it: digits alone, without needless zeros in front.
std::optional<std::size_t> plain_number(std::string_view text) {
    const auto number = parse_whole(text);
    if (!number || *number < 0 || std::to_string(*number) != text) return {};
    return static_cast<std::size_t>(*number);
}

/// Reads both lines at the front; what is left begins with the header, whose length is returned.
Result<std::size_t> read_front(std::string_view& bytes) {
    const auto first = take_line(bytes);
    if (!first || !first->starts_with(magic)) return bad_input("this is not a .yarns file", "byte 0");
    const auto version = plain_number(first->substr(magic.size()));
    if (!version || *version < 1) return bad_input("the version must be a whole number from 1 on", "line 1");
    if (*version > yarns_file_version) {
        return bad_input("is version " + std::to_string(*version) +
                             " of the format; this program reads version " +
                             std::to_string(yarns_file_version) + ", so a newer one is needed",
                         "line 1");
    }
    const auto second = take_line(bytes);
    const auto length = second ? plain_number(*second) : std::nullopt;
    if (!length) return bad_input("must be the length of the header in bytes", "line 2");
    if (*length > longest_yarns_header)
        return bad_input("says a header longer than " + std::to_string(longest_yarns_header) + " bytes",
                         "line 2");
    if (*length > bytes.size()) return bad_input("the file ends within its header", "line 2");
    return *length;
}

/// The header as text, padded so that the arrays begin at a multiple of 8 bytes.
Result<std::string> front_and_header(const Yarns& yarns, const std::vector<std::size_t>& points, std::size_t crossings) {
    try {
        const Json json = header_json(yarns, points, crossings);
        std::string text = json.dump();
        // What the reader would not give back, such as an infinite number in the report, is found by reading.
        WEAVE_TRY(const Header again, read_header(text));
        if (again.yarns.report != yarns.report) return bad_input("holds what JSON cannot say", "report");
        const std::string first = std::string(magic) + std::to_string(yarns_file_version) + "\n";
        for (;; text.push_back(' ')) {
            std::string front = first + std::to_string(text.size()) + "\n";
            if ((front.size() + text.size()) % 8 == 0) return front + text;
        }
    } catch (const Json::exception&) {
        return bad_input("has text that is not UTF-8");
    }
}

}  // namespace

std::string file_bytes(std::span<const double> numbers) {
    std::string bytes;
    bytes.reserve(8 * numbers.size());
    for (const double number : numbers) append_number(bytes, number);
    return bytes;
}

std::string file_bytes(std::span<const Crossing> crossings) {
    std::string bytes;
    bytes.reserve(crossing_bytes * crossings.size());
    for (const Crossing& crossing : crossings) {
        for (const std::size_t index : {crossing.weft, crossing.weft_key, crossing.warp, crossing.warp_key,
                                        crossing.pick, crossing.end, std::size_t{crossing.weft_over}}) {
            append_word(bytes, static_cast<std::uint32_t>(index));
        }
    }
    return bytes;
}

Result<YarnsLayout> lay_out_yarns(const Yarns& bare, const std::vector<std::size_t>& points, std::size_t crossings) {
    YarnsLayout layout;
    WEAVE_TRY(layout.front, front_and_header(bare, points, crossings));
    const std::size_t all = std::accumulate(points.begin(), points.end(), std::size_t{0});
    std::uint64_t at = layout.front.size();
    std::array<std::uint64_t*, 5> places{&layout.control, &layout.planned, &layout.strain, &layout.contact_N, &layout.crossings};
    const std::vector<ArrayPlace> arrays = array_table(all, crossings);
    for (std::size_t k = 0; k < places.size(); ++k) {
        *places[k] = at;
        at += arrays[k].bytes();
    }
    return layout;
}

Result<std::string> write_yarns(const Yarns& yarns) {
    for (std::size_t i = 0; i < yarns.yarns.size(); ++i) {
        Status status = check_sizes(yarns.yarns[i]);
        if (status) status = check_points(yarns.yarns[i]);
        if (!status) return std::move(status).error().under(yarn_place(i));
    }
    if (yarns.crossings.size() > most_file_crossings) return bad_input("are too many", "crossings");
    WEAVE_CHECK_OK(check_crossings(yarns));
    const std::vector<std::size_t> points = points_of(yarns);
    WEAVE_TRY(std::string bytes, front_and_header(yarns, points, yarns.crossings.size()));
    bytes.reserve(bytes.size() + std::accumulate(points.begin(), points.end(), std::size_t{0}) * (2 * point_bytes + 2 * number_bytes) +
                  yarns.crossings.size() * crossing_bytes);
    for (const SimulatedYarn& yarn : yarns.yarns) append_points(bytes, yarn.spline.control);
    for (const SimulatedYarn& yarn : yarns.yarns) append_points(bytes, yarn.planned);
    for (const SimulatedYarn& yarn : yarns.yarns) {
        for (const double strain : yarn.strain) append_number(bytes, strain);
    }
    for (const SimulatedYarn& yarn : yarns.yarns) {
        for (const double contact : yarn.contact_N) append_number(bytes, contact);
    }
    bytes += file_bytes(yarns.crossings);
    return bytes;
}

Result<Yarns> read_yarns(std::string_view bytes) {
    WEAVE_TRY(const std::size_t length, read_front(bytes));
    auto read = read_header(bytes.substr(0, length));
    if (!read) return std::move(read).error().in("header");
    Header header = std::move(read).value();
    bytes.remove_prefix(length);
    const std::size_t expected =
        header.all_points * (2 * point_bytes + 2 * number_bytes) + header.crossings * crossing_bytes;
    if (bytes.size() != expected) {
        return bad_input("the arrays should take " + std::to_string(expected) + " bytes but take " +
                             std::to_string(bytes.size()),
                         "arrays");
    }
    Taker taker(bytes);
    read_points(header, taker);
    for (std::size_t i = 0; i < header.yarns.yarns.size(); ++i) {
        if (auto status = check_points(header.yarns.yarns[i]); !status)
            return std::move(status).error().under(yarn_place(i));
    }
    WEAVE_CHECK_OK(read_crossings(header, taker));
    return std::move(header.yarns);
}

}  // namespace weave
