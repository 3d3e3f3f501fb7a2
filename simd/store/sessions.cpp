#include <algorithm>
#include <array>
#include <simd/store/rows.hpp>
#include <simd/store/store.hpp>

namespace weave::simd {

namespace {

const std::array<std::string, 4> kind_words{"layout", "phase", "other", "ended"};

const std::string& word_of(EventKind kind) {
    return kind_words[static_cast<std::size_t>(kind)];
}

EventKind event_kind(const std::string& word) {
    std::size_t k = 0;
    while (k + 1 < kind_words.size() && kind_words[k] != word) ++k;
    return static_cast<EventKind>(k);
}

/// How far the events of a session are.
struct Tail {
    Number last_seq = 0;
    bool ended = false;
};

Result<Tail> tail_of(sql::Connection& connection, Number session) {
    WEAVE_TRY(const auto tail, connection.one(
                                   "SELECT last_seq, ended FROM session WHERE number = ?",
                                   [](const sql::Row& row) {
                                       return Tail{number_at(row, 0), row.integer(1) != 0};
                                   },
                                   whole(session)));
    if (!tail) return no_such("session", session);
    return *tail;
}

Error out_of_order(Number session, const Event& event, const std::string& why) {
    return {ErrorCode::usage, "event " + std::to_string(event.seq) + " " + why,
            "session " + std::to_string(session)};
}

/// An event whose number is taken must be the one that has it, told once more. One that was dropped cannot be
/// compared any more, and all who should know it do.
Status pass_over(sql::Connection& connection, Number session, const Event& event) {
    WEAVE_TRY(const auto kept, connection.one(
                                   "SELECT kind, text FROM event WHERE session = ? AND seq = ?",
                                   [](const sql::Row& row) {
                                       return Event{0, event_kind(row.bytes(0)), row.bytes(1)};
                                   },
                                   whole(session), whole(event.seq)));
    if (kept && (kept->kind != event.kind || kept->text != event.text))
        return out_of_order(session, event, "is another one already");
    return {};
}

Status add_event(sql::Connection& connection, Number session, const Event& event, Tail& tail) {
    if (event.seq >= 1 && event.seq <= tail.last_seq) return pass_over(connection, session, event);
    if (tail.ended) return out_of_order(session, event, "comes after the last one");
    if (event.seq != tail.last_seq + 1)
        return out_of_order(session, event, "does not follow " + std::to_string(tail.last_seq));
    tail = {event.seq, event.kind == EventKind::ended};
    return connection.run("INSERT INTO event (session, seq, kind, text) VALUES (?, ?, ?, ?)", whole(session),
                          whole(event.seq), word_of(event.kind), event.text);
}

Status date_change(sql::Connection& connection, Number session, const Dated& dated) {
    WEAVE_CHECK_OK(
        connection.run("UPDATE change SET step = ?1, flip_told = max(flip_told, ?4) WHERE session = ?2 AND number = ?3 AND "
                       "coalesce(step, ?1) = ?1",
                       whole(dated.step), whole(session), whole(dated.change), std::int64_t{dated.flip_told}));
    if (connection.changes() == 1) return {};
    return Error{ErrorCode::usage,
                 "change " + std::to_string(dated.change) + " is not there, or took effect at another step",
                 "session " + std::to_string(session)};
}

/// Drops what was acknowledged and is not to be kept all the same.
Status drop_acknowledged(sql::Connection& connection, Number session) {
    WEAVE_TRY(const std::int64_t layout,
              connection.number(
                  "SELECT seq FROM event WHERE session = ? AND kind = 'layout' ORDER BY seq DESC LIMIT 1",
                  whole(session)));
    WEAVE_TRY(const std::int64_t phase,
              connection.number(
                  "SELECT seq FROM event WHERE session = ? AND kind = 'phase' ORDER BY seq DESC LIMIT 1",
                  whole(session)));
    return connection.run(
        "DELETE FROM event WHERE session = ?1 AND seq <= (SELECT acknowledged FROM session WHERE number = "
        "?1) "
        "AND kind <> 'ended' AND seq <> ?2 AND seq <> ?3",
        whole(session), layout, phase);
}

KeptSession session_of(const sql::Row& row) {
    KeptSession session;
    session.number = number_at(row, 0);
    session.person = row.bytes(1);
    session.request = row.bytes(2);
    session.title = row.bytes(3);
    session.state = {row.bytes(4),      number_at(row, 5), optional_number_at(row, 6),
                     number_at(row, 7), number_at(row, 8), number_at(row, 9)};
    session.last_seq = number_at(row, 10);
    session.acknowledged = number_at(row, 11);
    session.ended = row.integer(12) != 0;
    return session;
}

}  // namespace

Result<Made> Store::add_session(const NewSession& session, const AnswerOf& answer) {
    Made made;
    const auto add = [&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto before, made_before(connection, session.person, session.request));
        if (before) return made = *before, Status();
        WEAVE_TRY(const std::int64_t number,
                  connection.number("INSERT INTO session (person, request, title) VALUES (?, ?, ?) RETURNING number",
                                    session.person, session.request, session.title));
        WEAVE_CHECK_OK(
            connection.run("INSERT INTO session_task (session, document, simulation) VALUES (?, ?, ?)",
                           number, session.document, session.simulation));
        made.number = static_cast<Number>(number);
        made.answer = answer(made.number);
        return remember_answer(connection, session.person, session.request, made.answer, made.number);
    };
    WEAVE_CHECK_OK(write(add));
    return made;
}

Status Store::change_session(Number session, const SessionState& state) {
    return write([&](sql::Connection& connection) -> Status {
        WEAVE_CHECK_OK(
            connection.run("UPDATE session SET phase = ?, step = ?, pause_at = ?, frame = ?, layout = ?, "
                           "checkpoint_step = ? WHERE number = ?",
                           state.phase, whole(state.step), whole(state.pause_at), whole(state.frame),
                           whole(state.layout), whole(state.checkpoint_step), whole(session)));
        return connection.changes() == 1 ? Status() : Status(no_such("session", session));
    });
}

Result<std::vector<KeptSession>> Store::sessions() {
    std::vector<KeptSession> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(found, connection.all(
                             "SELECT number, person, request, title, phase, step, pause_at, frame, layout, "
                             "checkpoint_step, last_seq, acknowledged, ended FROM session ORDER BY "
                             "number",
                             session_of));
        return {};
    }));
    return found;
}

Result<SessionTask> Store::task_of_session(Number session) {
    std::optional<SessionTask> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(found, connection.one(
                             "SELECT document, simulation FROM session_task WHERE session = ?",
                             [](const sql::Row& row) {
                                 return SessionTask{row.bytes(0), row.bytes(1)};
                             },
                             whole(session)));
        return {};
    }));
    if (!found) return no_such("session", session);
    return *std::move(found);
}

Status Store::forget_session(Number session) {
    return write([&](sql::Connection& connection) {
        return connection.run("DELETE FROM session WHERE number = ?", whole(session));
    });
}

Status Store::add_events(Number session, const std::vector<Event>& events, const std::vector<Dated>& dated) {
    return write([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(Tail tail, tail_of(connection, session));
        for (const Event& event : events) WEAVE_CHECK_OK(add_event(connection, session, event, tail));
        for (const Dated& change : dated) WEAVE_CHECK_OK(date_change(connection, session, change));
        WEAVE_CHECK_OK(connection.run("UPDATE session SET last_seq = ?, ended = ? WHERE number = ?",
                                      whole(tail.last_seq), std::int64_t{tail.ended}, whole(session)));
        return drop_acknowledged(connection, session);
    });
}

Result<std::vector<Event>> Store::events_after(Number session, Number seq, std::size_t most) {
    std::vector<Event> found;
    const auto limit = std::min<std::size_t>(most, INT64_MAX);
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(found,
                  connection.all(
                      "SELECT seq, kind, text FROM event WHERE session = ? AND seq > ? ORDER BY seq LIMIT ?",
                      [](const sql::Row& row) {
                          return Event{number_at(row, 0), event_kind(row.bytes(1)), row.bytes(2)};
                      },
                      whole(session), whole(seq), static_cast<std::int64_t>(limit)));
        return {};
    }));
    return found;
}

Status Store::acknowledge(Number session, Number seq) {
    return write([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const Tail tail, tail_of(connection, session));
        if (seq > tail.last_seq)
            return Error{ErrorCode::usage, "there is no event " + std::to_string(seq) + " yet",
                         "session " + std::to_string(session)};
        WEAVE_CHECK_OK(
            connection.run("UPDATE session SET acknowledged = max(acknowledged, ?) WHERE number = ?",
                           whole(seq), whole(session)));
        return drop_acknowledged(connection, session);
    });
}

Result<Made> Store::add_change(Number session, const std::string& request, const std::string& change,
                               const AnswerOf& answer) {
    Made made;
    const auto add = [&](sql::Connection& connection) -> Status {
        WEAVE_TRY(const auto person, connection.one(
                                         "SELECT person FROM session WHERE number = ?",
                                         [](const sql::Row& row) { return row.bytes(0); }, whole(session)));
        if (!person) return no_such("session", session);
        WEAVE_TRY(const auto before, made_before(connection, *person, request));
        if (before) return made = *before, Status();
        WEAVE_TRY(const std::int64_t last,
                  connection.number("SELECT max(number) FROM change WHERE session = ?", whole(session)));
        WEAVE_CHECK_OK(
            connection.run("INSERT INTO change (session, number, request, text) VALUES (?, ?, ?, ?)",
                           whole(session), last + 1, request, change));
        made.number = static_cast<Number>(last + 1);
        made.answer = answer(made.number);
        return remember_answer(connection, *person, request, made.answer, made.number);
    };
    WEAVE_CHECK_OK(write(add));
    return made;
}

Result<std::vector<KeptChange>> Store::changes(Number session) {
    std::vector<KeptChange> found;
    WEAVE_CHECK_OK(read([&](sql::Connection& connection) -> Status {
        WEAVE_TRY(found,
                  connection.all(
                      "SELECT number, request, text, step, flip_told FROM change WHERE session = ? ORDER BY number",
                      [](const sql::Row& row) {
                          return KeptChange{number_at(row, 0), row.bytes(1), row.bytes(2),
                                            optional_number_at(row, 3), row.integer(4) != 0};
                      },
                      whole(session)));
        return {};
    }));
    return found;
}

}  // namespace weave::simd
