#pragma once

#include <weave/core/colour.hpp>
#include <weave/core/json.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace weave {

/// An interval that a number from outside must lie in, ends included.
struct Range {
    double low = -std::numeric_limits<double>::max();
    double high = std::numeric_limits<double>::max();
};

/// Reads the members of one JSON object with checks, remembering the first error of the whole document with
/// its path. After an error every read yields its fallback, so code that reads stays a plain list of members;
/// `status()` then tells the truth. Each member may be read once; `no_others()` refuses what nobody asked
/// for.
class JsonReader {
  public:
    JsonReader(const Json& value, std::string where);

    [[nodiscard]] bool has(const std::string& key) const;
    [[nodiscard]] const std::string& where() const { return m_where; }
    [[nodiscard]] const Json& json() const { return *m_value; }

    double number(const std::string& key, Range range, std::optional<double> fallback = {});
    /// A number that may be missing and then stands for something that only the caller knows.
    std::optional<double> optional_number(const std::string& key, Range range);
    std::int64_t integer(const std::string& key, std::int64_t low, std::int64_t high,
                         std::optional<std::int64_t> fallback = {});
    bool boolean(const std::string& key, std::optional<bool> fallback = {});
    /// A string of at most `longest` bytes.
    std::string text(const std::string& key, std::optional<std::string> fallback = {},
                     std::size_t longest = 65536);
    Colour colour(const std::string& key, std::optional<Colour> fallback = {});
    /// The index into `names` of the member's text, which must be one of them.
    std::size_t choice(const std::string& key, const std::vector<std::string>& names,
                       std::optional<std::size_t> fallback = {});
    std::vector<std::int64_t> integers(const std::string& key, std::int64_t low, std::int64_t high);
    /// A list of at most `most` strings. Missing: empty.
    std::vector<std::string> texts(const std::string& key, std::size_t most);

    /// A member that is an object. Missing: an empty object if `optional`, else an error.
    JsonReader object(const std::string& key, bool optional = false);
    /// A member that is an array of objects. Missing: empty if `optional`, else an error.
    std::vector<JsonReader> objects(const std::string& key, bool optional = false);
    /// The members of an object whose values are objects, in file order, with their names.
    std::vector<std::pair<std::string, JsonReader>> named_objects();
    /// A member as it stands, whatever it is; null if missing.
    const Json& raw(const std::string& key);

    /// An error if the object has members that were not read.
    void no_others();
    /// Records an error at this object, or at one of its members.
    void fail(const std::string& message, const std::string& key = {});
    [[nodiscard]] bool failed() const { return m_error->has_value(); }
    [[nodiscard]] Status status() const;

  private:
    JsonReader(const Json& value, std::string where, std::shared_ptr<std::optional<Error>> error);
    const Json* find(const std::string& key, bool required);
    [[nodiscard]] std::string place(const std::string& key) const;

    const Json* m_value;
    std::string m_where;
    std::shared_ptr<std::optional<Error>> m_error;
    std::set<std::string> m_read;
};

}  // namespace weave
