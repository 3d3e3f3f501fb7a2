#include <weave/sql/postgres_connection.hpp>

#include <weave/core/text.hpp>

#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <poll.h>

namespace weave::sql {

namespace {

// Types of the server's, by their numbers in its catalogue, which never change.
constexpr Oid bool_type = 16, bytea_type = 17, int8_type = 20, int2_type = 21, int4_type = 23, float8_type = 701;

/// All writers of a database wait for this one lock: the log is one chain.
constexpr const char* lock_writers = "SELECT pg_advisory_xact_lock(1465271883)";  // "WvLK"

std::uint64_t whole_of(const char* bytes, int size) {
    std::uint64_t number = 0;
    for (int k = 0; k < size; ++k) number = number << 8 | static_cast<unsigned char>(bytes[k]);
    return number;
}

class PostgresRow final : public Row {
  public:
    explicit PostgresRow(const PGresult* answer) : m_answer(answer) {}
    [[nodiscard]] int columns() const override { return PQnfields(m_answer); }
    [[nodiscard]] Value value(int column) const override {
        if (PQgetisnull(m_answer, 0, column) != 0) return {};
        const char* const bytes = PQgetvalue(m_answer, 0, column);
        const int size = PQgetlength(m_answer, 0, column);
        switch (PQftype(m_answer, column)) {
            case int8_type:
                return static_cast<std::int64_t>(whole_of(bytes, size));
            case int4_type:
                return std::int64_t{static_cast<std::int32_t>(whole_of(bytes, size))};
            case int2_type:
                return std::int64_t{static_cast<std::int16_t>(whole_of(bytes, size))};
            case bool_type:
                return std::int64_t{bytes[0]};
            case float8_type:
                return std::bit_cast<double>(whole_of(bytes, size));
            case bytea_type:
                return Blob{{bytes, static_cast<std::size_t>(size)}};
            default:
                return std::string_view(bytes, static_cast<std::size_t>(size));
        }
    }

  private:
    const PGresult* m_answer;
};

/// What is bound, as libpq takes it: numbers and text as text, bytes as they are.
struct Bound {
    std::vector<std::string> texts;
    std::vector<const char*> values;
    std::vector<int> sizes, formats;
};

std::string text_of(double number) {
    std::array<char, 32> text{};
    const auto end = std::to_chars(text.data(), text.data() + text.size(), number);
    return {text.data(), end.ptr};
}

Result<Bound> bound_of(std::span<const Value> values) {
    Bound bound;
    bound.texts.reserve(values.size());
    for (const Value& value : values) {
        const auto* const blob = std::get_if<Blob>(&value);
        const auto* const text = std::get_if<std::string_view>(&value);
        const auto* const real = std::get_if<double>(&value);
        const auto* const whole = std::get_if<std::int64_t>(&value);
        const bool is_null = value.index() == 0 || (real != nullptr && std::isnan(*real));
        if (text != nullptr && text->find('\0') != std::string_view::npos)
            return bad_input("holds a NUL character, which a store on PostgreSQL cannot keep");
        bound.texts.emplace_back(text != nullptr    ? std::string(*text)
                                 : real != nullptr  ? text_of(*real)
                                 : whole != nullptr ? std::to_string(*whole)
                                                    : std::string());
        const char* const bytes = blob == nullptr ? bound.texts.back().c_str() : blob->bytes.empty() ? "" : blob->bytes.data();
        bound.values.push_back(is_null ? nullptr : bytes);
        bound.sizes.push_back(blob == nullptr ? 0 : static_cast<int>(blob->bytes.size()));
        bound.formats.push_back(blob == nullptr ? 0 : 1);
    }
    return bound;
}

/// `?` and `?1` as the server numbers them, `$1`; those within quotes stay.
std::string numbered(std::string_view text) {
    std::string words;
    int count = 0;
    bool is_quoted = false;
    for (std::size_t k = 0; k < text.size(); ++k) {
        if (text[k] == '\'') is_quoted = !is_quoted;
        if (text[k] != '?' || is_quoted) {
            words += text[k];
            continue;
        }
        words += '$';
        if (k + 1 == text.size() || text[k + 1] < '0' || text[k + 1] > '9') words += std::to_string(++count);
    }
    return words;
}

/// What libpq tells in several lines.
std::string in_one_line(std::string_view text) {
    std::string words;
    for (const char c : text) {
        const bool is_space = c == '\n' || c == '\t' || c == ' ';
        if (!is_space) words += c;
        else if (!words.empty() && words.back() != ' ') words += ' ';
    }
    if (words.ends_with(' ')) words.pop_back();
    return on_one_line(words);
}

std::string field(const PGresult* answer, int code) {
    const char* const text = PQresultErrorField(answer, code);
    return text == nullptr ? "" : text;
}

}  // namespace

PostgresConnection::PostgresConnection(PGconn* handle, std::string place, std::chrono::milliseconds patience)
    : m_handle(handle), m_place(std::move(place)), m_patience(patience) {
    const auto known = [](const char* text) { return text == nullptr ? std::string() : std::string(text); };
    m_label = "PostgreSQL database '" + known(PQdb(m_handle)) + "' at " + known(PQhost(m_handle)) + " (port " +
              known(PQport(m_handle)) + ")";
    PQsetNoticeReceiver(m_handle, note_warning, this);
}

PostgresConnection::~PostgresConnection() {
    PQfinish(m_handle);
}

Status PostgresConnection::configure(Access access) {
    const bool reads = access == Access::read || access == Access::standby;
    return script("SET lock_timeout = " + std::to_string(m_patience.count()) +
                  "; SET synchronous_commit = remote_apply; SET default_transaction_isolation = 'read committed';"
                  "SET standard_conforming_strings = on; SET client_min_messages = warning; SET default_transaction_read_only = " +
                  (reads ? "on" : "off"));
}

Error PostgresConnection::lost() const {
    return system_fault("no connection to the server: " + in_one_line(PQerrorMessage(m_handle)), m_label);
}

/// What the server warns of. Where it stopped waiting for a standby, a warning of no kind of its own is all that tells it.
void PostgresConnection::note_warning(void* connection, const PGresult* notice) {
    if (field(notice, PG_DIAG_SEVERITY_NONLOCALIZED) == "WARNING")
        static_cast<PostgresConnection*>(connection)->m_warning = field(notice, PG_DIAG_MESSAGE_PRIMARY);
}

Result<PostgresConnection::Answer> PostgresConnection::next(const Deadline& deadline) {
    using namespace std::chrono;
    while (PQisBusy(m_handle) != 0) {
        pollfd waiting{PQsocket(m_handle), POLLIN, 0};
        const auto rest = deadline ? duration_cast<milliseconds>(*deadline - steady_clock::now()).count() : -1;
        const bool is_late = deadline && rest <= 0;
        if (is_late || ::poll(&waiting, 1, static_cast<int>(rest)) == 0) {
            m_is_late = true;
            return system_fault("the server did not confirm the commit in time, as when it waits for a synchronous standby that is "
                                "gone (synchronous_standby_names); it may have been stored: repeat the request with its id",
                                m_label);
        }
        if (PQconsumeInput(m_handle) == 0) break;  // what came before it went is an answer still
    }
    return Answer(PQgetResult(m_handle));
}

Status PostgresConnection::finish(const std::function<void(const Row&)>* take, const Deadline& deadline) {
    struct Drain {  // where `take` throws, the connection is still to be fit for more
        PostgresConnection* connection;
        ~Drain() {
            while (!connection->m_is_late && Answer(PQgetResult(connection->m_handle))) continue;
        }
    };
    const Drain drain{this};
    Status outcome;
    while (true) {
        const auto got = next(deadline);
        if (!got) return outcome ? Status(got.error()) : outcome;
        const Answer& answer = *got;
        if (!answer) return outcome;
        const ExecStatusType status = PQresultStatus(answer.get());
        if (status == PGRES_SINGLE_TUPLE) {
            if (take != nullptr) (*take)(PostgresRow(answer.get()));
        } else if (status == PGRES_COMMAND_OK || status == PGRES_TUPLES_OK) {
            const std::string_view count = PQcmdTuples(answer.get());
            m_changes = 0;
            std::from_chars(count.data(), count.data() + count.size(), m_changes);
            m_last_command = PQcmdStatus(answer.get());
        } else if (outcome) {  // the first says why: what follows is that the server went
            outcome = trouble(answer.get());
        }
    }
}

Status PostgresConnection::script(const std::string& text) {
    if (PQsendQuery(m_handle, text.c_str()) == 0) return lost();
    return finish(nullptr);
}

Status PostgresConnection::begin_read() {
    return script("BEGIN ISOLATION LEVEL REPEATABLE READ READ ONLY");
}

Status PostgresConnection::begin_write() {
    Status status = script("BEGIN ISOLATION LEVEL READ COMMITTED READ WRITE");
    if (status) status = script(lock_writers);
    if (!status && status.error().code == ErrorCode::system && is_usable()) {
        rollback();
        return system_fault(status.error().message + why_locked(), m_label);
    }
    return status;
}

Status PostgresConnection::commit() {
    m_warning.clear();
    if (PQsendQuery(m_handle, "COMMIT") == 0) return lost();
    Status status = finish(nullptr, std::chrono::steady_clock::now() + m_patience);
    if (m_is_late) return status;
    if (!status && !is_usable())
        return system_fault(status.error().message + "; what was being committed may have been stored: repeat the request with its id",
                            m_label);
    if (!status) return status;
    if (m_last_command != "COMMIT") return system_fault("the transaction was ended; nothing was stored", m_label);
    if (!m_warning.empty())
        return system_fault("the commit was stored here, but no standby has confirmed it (" + m_warning +
                                "): repeat the request with its id",
                            m_label);
    return {};
}

bool PostgresConnection::in_transaction() const {
    const PGTransactionStatusType status = PQtransactionStatus(m_handle);
    return status == PQTRANS_INTRANS || status == PQTRANS_INERROR;
}

bool PostgresConnection::is_usable() const {
    return !m_is_late && PQstatus(m_handle) == CONNECTION_OK;
}

Result<std::string> PostgresConnection::prepared(std::string_view text) {
    const auto known = m_statements.find(text);
    if (known != m_statements.end()) return known->second;
    const std::string name = "s" + std::to_string(m_statements.size());
    if (PQsendPrepare(m_handle, name.c_str(), numbered(text).c_str(), 0, nullptr) == 0) return lost();
    WEAVE_CHECK_OK(finish(nullptr));
    m_statements.emplace(text, name);
    return name;
}

Status PostgresConnection::rows(std::string_view text, std::span<const Value> values,
                                const std::function<void(const Row&)>& take) {
    WEAVE_TRY(const Bound bound, bound_of(values));
    WEAVE_TRY(const std::string name, prepared(text));
    if (PQsendQueryPrepared(m_handle, name.c_str(), static_cast<int>(values.size()), bound.values.data(), bound.sizes.data(),
                            bound.formats.data(), 1) == 0)
        return lost();
    PQsetSingleRowMode(m_handle);
    return finish(&take);
}

std::string PostgresConnection::why_locked() {
    const auto waits = number("SELECT count(*) FROM pg_stat_activity WHERE wait_event = 'SyncRep' AND datname = current_database()");
    return waits && *waits > 0 ? ": a commit waits for a synchronous standby that does not answer (synchronous_standby_names)" : "";
}

Error PostgresConnection::trouble(const PGresult* answer) {
    const std::string code = field(answer, PG_DIAG_SQLSTATE), message = field(answer, PG_DIAG_MESSAGE_PRIMARY);
    const auto is_of = [&](std::string_view kind) { return code.starts_with(kind); };
    if (code.empty()) return lost();
    if (code == "P0001") return {ErrorCode::refused, message, {}};
    if (code == "23505") return {ErrorCode::refused, "exists already (" + message + ")", {}};
    if (is_of("23")) return {ErrorCode::refused, "the store does not take it (" + message + ")", {}};
    if (is_of("22")) return bad_input("the store cannot keep it (" + message + ")");
    if (code == "42501") return system_fault("its role may not do that (" + message + ")", m_label);
    if (code == "53100" && field(answer, PG_DIAG_SEVERITY_NONLOCALIZED) == "PANIC")
        return system_fault("the disk of the server's write-ahead log is full (" + message + "), and the server went down: make room there, start it", m_label);
    if (code == "53100") return system_fault("the disk of the server is full; nothing was stored", m_label);
    if (code == "55P03") return system_fault("is in use by another program", m_label);
    if (code == "25006") return system_fault("may not be written: it is a standby, or was made read-only", m_label);
    if (is_of("57P")) return system_fault("the server is going down or starting (" + message + ")", m_label);
    if (is_of("XX") || code == "58030") return system_fault("is damaged, or its disk is (" + message + ")", m_label);
    return system_fault("the store failed: " + message, m_label);
}

}  // namespace weave::sql
