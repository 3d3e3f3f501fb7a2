#include <simd/store/rows.hpp>
#include <simd/store/store.hpp>

namespace weave::simd {

namespace {

constexpr std::int64_t most_answers = 1000;  // of a person

}  // namespace

Result<std::optional<Made>> made_before(sql::Connection& connection, const std::string& person,
                                        const std::string& request) {
    return connection.one(
        "SELECT made, text FROM answer WHERE person = ? AND request = ?",
        [](const sql::Row& row) {
            return Made{number_at(row, 0), row.bytes(1), false};
        },
        person, request);
}

Status remember_answer(sql::Connection& connection, const std::string& person, const std::string& request,
                       const std::string& answer, std::optional<Number> made) {
    WEAVE_CHECK_OK(connection.run(
        "INSERT INTO answer (person, request, text, made) VALUES (?, ?, ?, ?) ON CONFLICT DO NOTHING", person,
        request, answer, whole(made)));
    return connection.run(
        "DELETE FROM answer WHERE person = ?1 AND number <= "
        "(SELECT number FROM answer WHERE person = ?1 ORDER BY number DESC LIMIT 1 OFFSET ?2)",
        person, most_answers);
}

Status Store::remember(const std::string& person, const std::string& request, const std::string& answer) {
    return write([&](sql::Connection& connection) {
        return remember_answer(connection, person, request, answer, {});
    });
}

Result<std::optional<std::string>> Store::answer_of(const std::string& person, const std::string& request) {
    std::optional<std::string> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto made, made_before(connection, person, request));
        if (made) found = made->answer;
        return {};
    }));
    return found;
}

}  // namespace weave::simd
