#include <weave/core/json_reader.hpp>

#include <algorithm>
#include <cmath>

namespace weave {

namespace {

const Json empty_object = Json::object();
const Json null_value = nullptr;

std::string join(const std::vector<std::string>& names) {
    std::string text;
    for (const auto& name : names) text += (text.empty() ? "" : ", ") + name;
    return text;
}

/// Whether a value is written as a whole number that 64 bits with a sign can hold.
bool holds_whole_number(const Json& value) {
    return value.is_number_integer() && !(value.is_number_unsigned() && value.get<std::uint64_t>() > INT64_MAX);
}

std::string between(double low, double high) {
    const bool below = high >= std::numeric_limits<double>::max();
    if (below && low <= -std::numeric_limits<double>::max()) return "a number";
    if (below) return "a number not below " + ecmascript_number(low);
    return "a number from " + ecmascript_number(low) + " to " + ecmascript_number(high);
}

}  // namespace

JsonReader::JsonReader(const Json& value, std::string where)
    : JsonReader(value, std::move(where), std::make_shared<std::optional<Error>>()) {}

JsonReader::JsonReader(const Json& value, std::string where, std::shared_ptr<std::optional<Error>> error)
    : m_value(&value), m_where(std::move(where)), m_error(std::move(error)) {
    if (!m_value->is_object()) {
        fail("must be an object");
        m_value = &empty_object;
    }
}

bool JsonReader::has(const std::string& key) const {
    return m_value->contains(key);
}

std::string JsonReader::place(const std::string& key) const {
    if (key.empty()) return m_where;
    return m_where.empty() ? key : m_where + "." + key;
}

void JsonReader::fail(const std::string& message, const std::string& key) {
    if (!m_error->has_value()) *m_error = bad_input(message, place(key));
}

Status JsonReader::status() const {
    if (m_error->has_value()) return **m_error;
    return {};
}

const Json* JsonReader::find(const std::string& key, bool required) {
    m_read.insert(key);
    const auto member = m_value->find(key);
    if (member != m_value->end()) return &*member;
    if (required) fail("is missing", key);
    return nullptr;
}

double JsonReader::number(const std::string& key, Range range, std::optional<double> fallback) {
    const double spare = fallback.value_or(std::clamp(0.0, range.low, range.high));
    const Json* member = find(key, !fallback);
    if (member == nullptr) return spare;
    const double value = member->is_number() ? member->get<double>() : std::nan("");
    if (value >= range.low && value <= range.high) return value;
    fail("must be " + between(range.low, range.high), key);
    return spare;
}

std::optional<double> JsonReader::optional_number(const std::string& key, Range range) {
    if (!has(key)) return {};
    return number(key, range);
}

std::int64_t JsonReader::integer(const std::string& key, std::int64_t low, std::int64_t high,
                                 std::optional<std::int64_t> fallback) {
    const std::int64_t spare = fallback.value_or(low);
    const Json* member = find(key, !fallback);
    if (member == nullptr) return spare;
    if (holds_whole_number(*member)) {
        const auto value = member->get<std::int64_t>();
        if (value >= low && value <= high) return value;
    }
    fail("must be a whole number from " + std::to_string(low) + " to " + std::to_string(high), key);
    return spare;
}

bool JsonReader::boolean(const std::string& key, std::optional<bool> fallback) {
    const Json* member = find(key, !fallback);
    if (member == nullptr) return fallback.value_or(false);
    if (member->is_boolean()) return member->get<bool>();
    fail("must be true or false", key);
    return fallback.value_or(false);
}

std::string JsonReader::text(const std::string& key, std::optional<std::string> fallback,
                             std::size_t longest) {
    const Json* member = find(key, !fallback);
    if (member == nullptr) return fallback.value_or("");
    if (!member->is_string()) {
        fail("must be a text", key);
    } else if (member->get_ref<const std::string&>().size() > longest) {
        fail("is longer than " + std::to_string(longest) + " bytes", key);
    } else {
        return member->get<std::string>();
    }
    return fallback.value_or("");
}

Colour JsonReader::colour(const std::string& key, std::optional<Colour> fallback) {
    if (!has(key) && fallback) {
        m_read.insert(key);
        return *fallback;
    }
    const Result<Colour> colour = parse_colour(text(key));
    if (colour) return *colour;
    fail(colour.error().message, key);
    return fallback.value_or(Colour{});
}

std::size_t JsonReader::choice(const std::string& key, const std::vector<std::string>& names,
                               std::optional<std::size_t> fallback) {
    const Json* member = find(key, !fallback);
    if (member == nullptr) return fallback.value_or(0);
    if (member->is_string()) {
        const auto found = std::find(names.begin(), names.end(), member->get_ref<const std::string&>());
        if (found != names.end()) return static_cast<std::size_t>(found - names.begin());
    }
    fail("must be one of " + join(names), key);
    return fallback.value_or(0);
}

std::vector<std::int64_t> JsonReader::integers(const std::string& key, std::int64_t low, std::int64_t high) {
    std::vector<std::int64_t> values;
    const Json* member = find(key, true);
    if (member == nullptr) return values;
    if (!member->is_array()) {
        fail("must be a list of whole numbers", key);
        return values;
    }
    for (std::size_t i = 0; i < member->size(); ++i) {
        const Json& item = (*member)[i];
        if (!holds_whole_number(item) || item.get<std::int64_t>() < low || item.get<std::int64_t>() > high) {
            fail("must be a whole number from " + std::to_string(low) + " to " + std::to_string(high),
                 key + "[" + std::to_string(i) + "]");
            return values;
        }
        values.push_back(item.get<std::int64_t>());
    }
    return values;
}

std::vector<std::string> JsonReader::texts(const std::string& key, std::size_t most) {
    std::vector<std::string> values;
    const Json* member = find(key, false);
    if (member == nullptr) return values;
    if (!member->is_array() || member->size() > most) {
        fail("must be a list of at most " + std::to_string(most) + " texts", key);
        return values;
    }
    for (std::size_t i = 0; i < member->size(); ++i) {
        const Json& item = (*member)[i];
        if (item.is_string())
            values.push_back(item.get<std::string>());
        else
            fail("must be a text", key + "[" + std::to_string(i) + "]");
    }
    return values;
}

JsonReader JsonReader::object(const std::string& key, bool optional) {
    const Json* member = find(key, !optional);
    return {member != nullptr ? *member : empty_object, place(key), m_error};
}

std::vector<JsonReader> JsonReader::objects(const std::string& key, bool optional) {
    std::vector<JsonReader> readers;
    const Json* member = find(key, !optional);
    if (member == nullptr) return readers;
    if (!member->is_array()) {
        fail("must be a list", key);
        return readers;
    }
    for (std::size_t i = 0; i < member->size(); ++i) {
        readers.push_back(JsonReader((*member)[i], place(key) + "[" + std::to_string(i) + "]", m_error));
    }
    return readers;
}

std::vector<std::pair<std::string, JsonReader>> JsonReader::named_objects() {
    std::vector<std::pair<std::string, JsonReader>> readers;
    for (auto it = m_value->begin(); it != m_value->end(); ++it) {
        m_read.insert(it.key());
        readers.emplace_back(it.key(), JsonReader(it.value(), place(it.key()), m_error));
    }
    return readers;
}

const Json& JsonReader::raw(const std::string& key) {
    const Json* member = find(key, false);
    return member != nullptr ? *member : null_value;
}

void JsonReader::no_others() {
    for (auto it = m_value->begin(); it != m_value->end(); ++it) {
        if (!m_read.contains(it.key())) fail("is not known here", it.key());
    }
}

}  // namespace weave
