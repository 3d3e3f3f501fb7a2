#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace weave::sql {

/// Bytes to be bound as a BLOB, as an array of bytes is; a plain string is bound as TEXT.
struct Blob {
    std::string_view bytes;
};

/// What is bound, or what a row holds: nothing, a number, TEXT, or a BLOB. Text and bytes belong to somebody else.
using Value = std::variant<std::monostate, std::int64_t, double, std::string_view, Blob>;

/// What the row that a statement stands on holds, column by column from 0. It lives until the next one.
class Row {
  public:
    [[nodiscard]] virtual int columns() const = 0;
    [[nodiscard]] virtual Value value(int column) const = 0;

    /// 0 and 0.0 where the column holds something else.
    [[nodiscard]] std::int64_t integer(int column) const;
    [[nodiscard]] double real(int column) const;
    [[nodiscard]] bool is_null(int column) const { return value(column).index() == 0; }
    /// A number, text, or null; of a BLOB its bytes in hexadecimal.
    [[nodiscard]] Json json(int column) const;
    /// TEXT or BLOB as it is.
    [[nodiscard]] std::string bytes(int column) const { return std::string(view(column)); }
    /// A BLOB of a fixed size, such as a hash: `fixed<std::array<unsigned char, 32>>(0)`; zeros where the
    /// column holds anything else.
    template <class Array>
    [[nodiscard]] Array fixed(int column) const {
        Array value{};
        const std::string_view found = view(column);
        if (found.size() == value.size()) std::copy(found.begin(), found.end(), value.begin());
        return value;
    }

  protected:
    Row() = default;
    ~Row() = default;

  private:
    [[nodiscard]] std::string_view view(int column) const;
};

enum class Engine : std::uint8_t { sqlite, postgres };

/// What a place names: the path of a file is SQLite's; `postgresql://…` (or `postgres://…`) a database of PostgreSQL's, as
/// libpq reads it.
Engine engine_of(std::string_view place);

/// `standby` reads as `read` does, from a server that follows another; only PostgreSQL has one.
enum class Access : std::uint8_t { create, write, read, standby };

/// What a database says of itself: whose it is and of which version; zeros where nobody has said so yet.
struct Stamp {
    std::int64_t application = 0, version = 0;
};

/// Something that a database finds wrong with itself.
using Find = std::function<void(const std::string& place, const std::string& cause)>;

/// One connection with the settings of a store, and its prepared statements. For one thread at a time. Statements are
/// written in what both engines understand, with `?` or `?1` for what is bound.
class Connection {
  public:
    /// Opens a database. `create` makes a file that is missing (a server's database must be there), `write` and
    /// `read` refuse what is missing. Writing is durable, on a synchronous standby as well where the server has one.
    /// Each statement waits `patience` for other connections that are in its way. A place that holds a password is
    /// refused: it belongs into a file or the environment (libpq's `passfile`).
    static Result<std::unique_ptr<Connection>> open(
        const std::string& place, Access access,
        std::chrono::milliseconds patience = std::chrono::seconds(10));
    virtual ~Connection() = default;
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    [[nodiscard]] virtual Engine engine() const = 0;

    /// Runs a script of fixed text, such as a migration. No value ever goes into its text.
    virtual Status script(const std::string& text) = 0;

    /// A transaction that reads one unchanging view, beside others that write.
    virtual Status begin_read() = 0;
    /// A transaction that writes, and sees all that was written before: there is one at a time.
    virtual Status begin_write() = 0;
    /// Answers once all of it is durable. Where the error says so, it may have been stored all the same.
    virtual Status commit() = 0;
    void rollback() {
        if (in_transaction()) static_cast<void>(script("ROLLBACK"));
    }
    /// Whether a transaction is open; a full disk may have ended one.
    [[nodiscard]] virtual bool in_transaction() const = 0;
    /// False once the way to a server is lost: the connection is good for nothing more.
    [[nodiscard]] virtual bool is_usable() const = 0;
    /// Rows that the last statement changed.
    [[nodiscard]] virtual std::int64_t changes() const = 0;

    /// Runs a statement without an answer.
    template <class... Values>
    Status run(std::string_view text, const Values&... values) {
        return each(
            text, [](const Row&) {}, values...);
    }
    /// Calls `take(row)` for each row. It must not use the connection.
    template <class Take, class... Values>
    Status each(std::string_view text, Take take, const Values&... values) {
        const std::array<Value, sizeof...(Values)> all{bound(values)...};
        return rows(text, all, std::ref(take));
    }
    /// All rows as `make(row)` makes them.
    template <class Make, class... Values>
    auto all(std::string_view text, Make make, const Values&... values)
        -> Result<std::vector<decltype(make(std::declval<const Row&>()))>> {
        std::vector<decltype(make(std::declval<const Row&>()))> rows;
        WEAVE_CHECK_OK(each(
            text, [&](const Row& row) { rows.push_back(make(row)); }, values...));
        return rows;
    }
    /// The first row, or nothing.
    template <class Make, class... Values>
    auto one(std::string_view text, Make make, const Values&... values)
        -> Result<std::optional<decltype(make(std::declval<const Row&>()))>> {
        std::optional<decltype(make(std::declval<const Row&>()))> found;
        WEAVE_CHECK_OK(each(
            text,
            [&](const Row& row) {
                if (!found) found = make(row);
            },
            values...));
        return found;
    }
    /// The number in the first column of the first row; 0 without a row. An INSERT tells its row's with RETURNING.
    template <class... Values>
    Result<std::int64_t> number(std::string_view text, const Values&... values) {
        WEAVE_TRY(const auto found, one(
                                        text, [](const Row& row) { return row.integer(0); }, values...));
        return found.value_or(0);
    }
    /// Calls `take(row)` for each row of a statement that binds any number of values.
    virtual Status rows(std::string_view text, std::span<const Value> values,
                        const std::function<void(const Row&)>& take) = 0;

    // Where the engines differ in more than their words.

    virtual Result<Stamp> stamp() = 0;
    virtual Status set_stamp(const Stamp& stamp) = 0;
    /// Whether there are no tables.
    virtual Result<bool> is_empty() = 0;
    /// Removes everything, within a transaction, so that it can be filled anew.
    virtual Status clear() = 0;
    /// Damaged pages, where the engine looks at them when asked.
    virtual Status inspect_pages(const Find& find) = 0;
    /// Rows that point at rows that are not there.
    virtual Status inspect_links(const Find& find) = 0;
    /// The schema in words, one for each table, index, trigger and constraint: two that are alike have the same.
    virtual Result<std::set<std::string>> rules() = 0;
    /// An empty database of the same engine, in an open transaction; it goes with its connection.
    virtual Result<std::unique_ptr<Connection>> scratch() = 0;
    /// Runs `fill` with all triggers asleep, as a copy of a whole database needs; within a transaction.
    virtual Status load(const std::function<Status()>& fill) = 0;

  protected:
    Connection() = default;

  private:
    static Value bound(std::int64_t value) { return value; }
    static Value bound(double value) { return value; }
    static Value bound(const std::string& value) { return std::string_view(value); }
    static Value bound(Blob value) { return value; }
    template <std::size_t Size>
    static Value bound(const std::array<unsigned char, Size>& value) {
        return Blob{{reinterpret_cast<const char*>(value.data()), Size}};
    }
    template <class Bound>
    static Value bound(const std::optional<Bound>& value) {
        return value ? bound(*value) : Value();
    }
};

}  // namespace weave::sql
