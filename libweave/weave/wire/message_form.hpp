#pragma once

#include <weave/core/json_reader.hpp>
#include <weave/core/text.hpp>
#include <weave/wire/frame.hpp>

#include <algorithm>
#include <array>
#include <concepts>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

// Private. The members of a message are described once, and the description serves both ways: a form either reads them
// from JSON or writes them. `describe(form, part)` lists the members of a part.

namespace weave::wire::form {

/// T, or const T.
template <class M, class T>
concept Either = std::same_as<std::remove_const_t<M>, T>;

using Names = std::vector<std::string>;

inline bool is_request_id(const std::string& id) {
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '.' || c == '-' || c == '_'; };
    return id.size() >= 8 && id.size() <= 64 && std::ranges::all_of(id, fits);
}

/// Reads members from one JSON object.
class Reading {
  public:
    static constexpr bool reads = true;
    explicit Reading(JsonReader& reader) : m_reader(reader) {}
    [[nodiscard]] JsonReader& reader() { return m_reader; }

    template <std::unsigned_integral T>
    void count(const char* key, T& value, std::uint64_t low = 0, std::uint64_t high = most_number) {
        value = static_cast<T>(m_reader.integer(key, static_cast<std::int64_t>(low), static_cast<std::int64_t>(high)));
    }
    void number(const char* key, double& value, Range range) { value = m_reader.number(key, range); }
    void flag(const char* key, bool& value) { value = m_reader.boolean(key); }
    void text(const char* key, std::string& value, std::size_t longest) { value = m_reader.text(key, {}, longest); }
    void colour(const char* key, Colour& value) {
        const std::string text = m_reader.text(key, {}, 7);
        const Result<Colour> colour = parse_colour(text);
        if (!colour || to_text(*colour) != text) return m_reader.fail("must be #rrggbb in lower case", key);
        value = *colour;
    }
    template <class Enum>
    void word(const char* key, Enum& value, const Names& names) {
        value = static_cast<Enum>(m_reader.choice(key, names));
    }
    void request(std::string& value) {
        text("request", value, 64);
        if (!is_request_id(value)) m_reader.fail("must be 8 to 64 of the letters a to z, digits, '.', '-' and '_'", "request");
    }
    void object(const char* key, Json& value) {
        value = m_reader.raw(key);
        if (!value.is_object()) m_reader.fail("must be an object", key);
    }

    /// A member that may be missing: `read` reads it as one of the others.
    template <class T, class Read>
    void maybe(const char* key, std::optional<T>& value, const Read& read) {
        value.reset();
        if (m_reader.has(key)) read(*this, value.emplace());
    }
    template <class Part>
    void part(const char* key, Part& value) {
        read_part(m_reader.object(key), value);
    }
    template <class Part>
    void parts(const char* key, std::vector<Part>& list, std::size_t most) {
        list.clear();
        if (m_reader.raw(key).size() > most) return m_reader.fail("has more than " + std::to_string(most) + " items", key);
        for (JsonReader& item : m_reader.objects(key)) {
            if (item.failed()) return;
            read_part(item, list.emplace_back());
        }
    }
    /// A list of so many values; `convert.read(item)` gives one, or nothing where it does not fit.
    template <class T, std::size_t count, class Convert>
    void row(const char* key, std::array<T, count>& values, const char* wish, const Convert& convert) {
        if (!take_row(m_reader.raw(key), values, convert)) m_reader.fail(wish, key);
    }
    template <class T, class Convert>
    void list(const char* key, std::vector<T>& values, std::size_t most, const char* wish, const Convert& convert) {
        const Json& items = m_reader.raw(key);
        if (!items.is_array() || items.size() > most) return m_reader.fail(wish, key);
        values.clear();
        for (std::size_t i = 0; i < items.size(); ++i) {
            const std::optional<T> value = convert.read(items[i]);
            if (!value) return m_reader.fail(wish, indexed(key, i));
            values.push_back(*value);
        }
    }

  private:
    template <class T, std::size_t count, class Convert>
    static bool take_row(const Json& items, std::array<T, count>& values, const Convert& convert) {
        if (!items.is_array() || items.size() != count) return false;
        for (std::size_t i = 0; i < count; ++i) {
            const std::optional<T> value = convert.read(items[i]);
            if (!value) return false;
            values[i] = *value;
        }
        return true;
    }
    template <class Part>
    static void read_part(JsonReader reader, Part& value) {
        Reading inner(reader);
        describe(inner, value);
        reader.no_others();
    }

    JsonReader& m_reader;
};

/// Writes the same members into one JSON object.
class Writing {
  public:
    static constexpr bool reads = false;
    explicit Writing(Json& json) : m_json(json) {}
    [[nodiscard]] Json& json() { return m_json; }

    template <std::unsigned_integral T>
    void count(const char* key, T value, std::uint64_t = 0, std::uint64_t = 0) {
        m_json[key] = value;
    }
    void number(const char* key, double value, Range) { m_json[key] = value; }
    void flag(const char* key, bool value) { m_json[key] = value; }
    void text(const char* key, const std::string& value, std::size_t) {
        m_json[key] = is_utf8(value) ? value : on_one_line(value);
    }
    void colour(const char* key, Colour value) { m_json[key] = to_text(value); }
    template <class Enum>
    void word(const char* key, Enum value, const Names& names) {
        m_json[key] = names[static_cast<std::size_t>(value)];
    }
    void request(const std::string& value) { text("request", value, 64); }
    void object(const char* key, const Json& value) { m_json[key] = value; }

    template <class T, class Write>
    void maybe(const char*, const std::optional<T>& value, const Write& write) {
        if (value) write(*this, *value);
    }
    template <class Part>
    void part(const char* key, const Part& value) {
        m_json[key] = written(value);
    }
    template <class Part>
    void parts(const char* key, const std::vector<Part>& list, std::size_t) {
        Json& items = m_json[key] = Json::array();
        for (const Part& value : list) items.push_back(written(value));
    }
    template <class T, std::size_t count, class Convert>
    void row(const char* key, const std::array<T, count>& values, const char*, const Convert& convert) {
        Json& items = m_json[key] = Json::array();
        for (const T& value : values) items.push_back(convert.written(value));
    }
    template <class T, class Convert>
    void list(const char* key, const std::vector<T>& values, std::size_t, const char*, const Convert& convert) {
        Json& items = m_json[key] = Json::array();
        for (const T& value : values) items.push_back(convert.written(value));
    }

  private:
    template <class Part>
    static Json written(const Part& value) {
        Json json = Json::object();
        Writing inner(json);
        describe(inner, value);
        return json;
    }

    Json& m_json;
};

}  // namespace weave::wire::form
