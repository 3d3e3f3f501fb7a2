#include <weave/core/json.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>
#include <vector>

namespace weave {

namespace {

constexpr std::size_t deepest_level = 64;
constexpr std::size_t most_members =
    4096;  // who reads ordered objects searches linearly: a bound keeps hostile files cheap

/// nlohmann's message from the place on, without what its grammar looked for and had read: "line 3, column 7: invalid literal".
std::string parser_message(std::string message) {
    const auto place = message.find(" at line ");
    if (place != std::string::npos) {
        message.erase(0, place + 4);
        const auto grammar = message.find("syntax error while parsing "), reason = message.find(" - ", grammar);
        if (reason == std::string::npos) return message;
        const std::string why = message.substr(reason + 3, message.find("; ", reason) - reason - 3);
        return message.substr(0, grammar) + (why == "unexpected end of input" ? "it ends too early" : why);
    }
    const auto bracket = message.find("] ");
    return bracket == std::string::npos ? message : message.substr(bracket + 2);
}

/// Builds the value from what the parser reports, and stops it at what it would accept: repeated names, and
/// objects without end. nlohmann's own builder with a callback is no help: at the end of each object it looks
/// through all that its parent holds so far, so a long list of objects takes a time that grows with its
/// square.
class Builder final : public nlohmann::json_sax<Json> {
  public:
    bool null() override { return add(nullptr); }
    bool boolean(bool value) override { return add(value); }
    bool number_integer(number_integer_t value) override { return add(value); }
    bool number_unsigned(number_unsigned_t value) override { return add(value); }
    bool number_float(number_float_t value, const string_t&) override { return add(value); }
    bool string(string_t& value) override { return add(std::move(value)); }
    bool binary(binary_t& value) override { return add(std::move(value)); }
    bool start_object(std::size_t) override { return open(Json::value_t::object); }
    bool start_array(std::size_t) override { return open(Json::value_t::array); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override;
    bool parse_error(std::size_t, const std::string&, const nlohmann::json::exception& trouble) override {
        return refuse("is not JSON: " + parser_message(trouble.what()));
    }

    [[nodiscard]] Result<Json> result() && {
        if (m_error) return std::move(*m_error);
        return std::move(m_root);
    }

  private:
    /// An object or array that has begun and not ended.
    struct Open {
        Json* value;
        std::set<std::string> names;  ///< of its members so far
    };

    /// Where the next value goes. A parent does not grow while a child is open, so that pointers stay right.
    Json& place() {
        if (m_open.empty()) return m_root;
        Json& parent = *m_open.back().value;
        if (parent.is_array()) return parent.get_ref<Json::array_t&>().emplace_back();
        return parent.get_ref<Json::object_t&>().back().second;  // of the member whose name came last
    }
    bool add(Json value) {
        place() = std::move(value);
        return true;
    }
    /// The parser recurses nowhere, but whoever walks the result does: so depth is bounded.
    bool open(Json::value_t type) {
        if (m_open.size() == deepest_level) return refuse("nests deeper than " + std::to_string(deepest_level) + " levels");
        Json& value = place();
        value = Json(type);
        m_open.push_back({&value, {}});
        return true;
    }
    bool close() {
        m_open.pop_back();
        return true;
    }
    bool refuse(std::string message) {
        m_error = bad_input(std::move(message));
        return false;
    }

    Json m_root;
    std::vector<Open> m_open;
    std::optional<Error> m_error;
};

bool Builder::key(string_t& name) {
    Open& object = m_open.back();
    if (!object.names.insert(name).second) return refuse("repeats the member '" + name + "'");
    if (object.names.size() > most_members)
        return refuse("has an object with more than " + std::to_string(most_members) + " members");
    // at the end, without the search for an equal name that emplace() of the object makes
    object.value->get_ref<Json::object_t&>().emplace_back(std::move(name), nullptr);
    return true;
}

std::u16string utf16(std::string_view utf8) {
    std::u16string units;
    for (std::size_t i = 0; i < utf8.size();) {
        const auto lead = static_cast<unsigned char>(utf8[i]);
        const int length = lead < 0x80 ? 1 : lead < 0xe0 ? 2 : lead < 0xf0 ? 3 : 4;
        char32_t point = length == 1 ? lead : lead & (0x7f >> length);
        for (int k = 1; k < length && i + static_cast<std::size_t>(k) < utf8.size(); ++k) {
            point = point << 6 | (static_cast<unsigned char>(utf8[i + static_cast<std::size_t>(k)]) & 0x3f);
        }
        i += static_cast<std::size_t>(length);
        if (point < 0x10000) {
            units.push_back(static_cast<char16_t>(point));
        } else {
            units.push_back(static_cast<char16_t>(0xd7c0 + (point >> 10)));
            units.push_back(static_cast<char16_t>(0xdc00 + (point & 0x3ff)));
        }
    }
    return units;
}

void append_string(std::string& out, std::string_view text) {
    constexpr char digits[] = "0123456789abcdef";
    out.push_back('"');
    for (const char c : text) {
        const auto byte = static_cast<unsigned char>(c);
        switch (c) {
            case '"':
                out += "\\\"";
                break;
            case '\\':
                out += "\\\\";
                break;
            case '\b':
                out += "\\b";
                break;
            case '\f':
                out += "\\f";
                break;
            case '\n':
                out += "\\n";
                break;
            case '\r':
                out += "\\r";
                break;
            case '\t':
                out += "\\t";
                break;
            default:
                if (byte < 0x20) {
                    out += "\\u00";
                    out.push_back(digits[byte >> 4]);
                    out.push_back(digits[byte & 15]);
                } else {
                    out.push_back(c);
                }
        }
    }
    out.push_back('"');
}

void append(std::string& out, const Json& value);

void append_object(std::string& out, const Json& object) {
    std::vector<std::pair<std::u16string, Json::const_iterator>> members;
    for (auto it = object.begin(); it != object.end(); ++it) members.emplace_back(utf16(it.key()), it);
    std::sort(members.begin(), members.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    out.push_back('{');
    for (const auto& [key, member] : members) {
        if (out.back() != '{') out.push_back(',');
        append_string(out, member.key());
        out.push_back(':');
        append(out, member.value());
    }
    out.push_back('}');
}

void append(std::string& out, const Json& value) {
    switch (value.type()) {
        case Json::value_t::object:
            return append_object(out, value);
        case Json::value_t::array:
            out.push_back('[');
            for (std::size_t i = 0; i < value.size(); ++i) {
                if (i > 0) out.push_back(',');
                append(out, value[i]);
            }
            out.push_back(']');
            return;
        case Json::value_t::string:
            return append_string(out, value.get_ref<const std::string&>());
        case Json::value_t::boolean:
            out += value.get<bool>() ? "true" : "false";
            return;
        case Json::value_t::number_integer:
        case Json::value_t::number_unsigned:
        case Json::value_t::number_float:
            out += ecmascript_number(value.get<double>());
            return;
        default:
            out += "null";
    }
}

}  // namespace

Result<Json> parse_json(std::string_view text) {
    Builder builder;
    Json::sax_parse(text.begin(), text.end(), &builder);
    return std::move(builder).result();
}

std::string ecmascript_number(double value) {
    assert(std::isfinite(value));
    if (value == 0) return "0";
    char buffer[40];
    const auto end =
        std::to_chars(buffer, buffer + sizeof buffer, std::abs(value), std::chars_format::scientific).ptr;
    const std::string_view shortest(buffer, static_cast<std::size_t>(end - buffer));
    const auto e = shortest.find('e');
    std::string digits(shortest.substr(0, 1));
    if (e > 1) digits += shortest.substr(2, e - 2);
    int exponent = 0;
    std::string_view exponent_text = shortest.substr(e + 1);
    if (exponent_text.front() == '+') exponent_text.remove_prefix(1);
    std::from_chars(exponent_text.data(), exponent_text.data() + exponent_text.size(), exponent);
    const int count = static_cast<int>(digits.size());
    const int point = exponent + 1;  // the value is 0.DIGITS * 10^point
    std::string text = value < 0 ? "-" : "";
    if (count <= point && point <= 21) {
        text += digits + std::string(static_cast<std::size_t>(point - count), '0');
    } else if (0 < point && point <= 21) {
        text += digits.substr(0, static_cast<std::size_t>(point)) + "." +
                digits.substr(static_cast<std::size_t>(point));
    } else if (-6 < point && point <= 0) {
        text += "0." + std::string(static_cast<std::size_t>(-point), '0') + digits;
    } else {
        text += digits.substr(0, 1);
        if (count > 1) text += "." + digits.substr(1);
        text += exponent < 0 ? "e-" : "e+";
        text += std::to_string(std::abs(exponent));
    }
    return text;
}

std::string canonical_json(const Json& value) {
    std::string out;
    append(out, value);
    return out;
}

}  // namespace weave
