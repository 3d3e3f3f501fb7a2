#include "store_model.hpp"

#include <algorithm>
#include <cinttypes>

namespace weave::simd::testing {

namespace {

using Kind = Operation::Kind;

const std::string usage = "usage";

std::string text(Number number) {
    return std::to_string(number) + ";";
}
std::string text(const std::string& words) {
    return "'" + words + "';";
}
std::string text(const std::optional<Number>& number) {
    return number ? text(*number) : "none;";
}
std::string text(const std::optional<double>& number) {
    return number ? std::to_string(*number) + ";" : "none;";
}
std::string text(const std::optional<std::string>& words) {
    return words ? text(*words) : "none;";
}
std::string text(const Made& made) {
    return text(made.number) + text(made.answer) + (made.anew ? "new" : "known");
}
std::string text(const Event& event) {
    return text(event.seq) + text(static_cast<Number>(event.kind)) + text(event.text);
}
std::string text(const KeptChange& change) {
    return text(change.number) + text(change.request) + text(change.text) + text(change.step) + text(Number{change.flip_told});
}
std::string text(const KeptSession& session) {
    const SessionState& state = session.state;
    return text(session.number) + text(session.person) + text(session.request) + text(session.title) +
           text(state.phase) + text(state.step) + text(state.pause_at) + text(state.frame) +
           text(state.layout) + text(state.checkpoint_step) +
           text(session.last_seq) + text(session.acknowledged) + text(Number{session.ended});
}
std::string text(const KeptJob& job) {
    std::string all = text(job.number) + text(job.person) + text(job.request) + text(job.title) +
                      text(static_cast<Number>(job.phase)) + text(job.attempts) + text(job.step) +
                      text(job.residual);
    if (job.end)
        all += text(static_cast<Number>(job.end->phase)) + text(job.end->error) + text(job.end->report) +
               text(job.end->evidence) + text(job.end->yarns);
    return all;
}
std::string text(const SessionTask& task) {
    return text(task.document) + text(task.simulation);
}
std::string text(const JobTask& task) {
    return text(task.document) + text(task.simulation);
}
template <class T>
std::string text(const std::vector<T>& list) {
    std::string all;
    for (const T& item : list) all += text(item) + "\n";
    return all;
}

std::string outcome(const Status& status) {
    return status ? "done" : std::string(kind_of(status.error().code));
}
template <class T>
std::string outcome(const Result<T>& result) {
    return result ? text(*result) : std::string(kind_of(result.error().code));
}

AnswerOf answer_to(const Operation& operation) {
    return [&operation](Number made) { return operation.text + " made " + std::to_string(made); };
}
NewSession session_of(const Operation& operation) {
    return {operation.person, operation.request, "title " + operation.text, "document " + operation.text,
            "simulation"};
}
NewJob job_of(const Operation& operation) {
    return {operation.person,
            operation.request,
            "title " + operation.text,
            "document " + operation.text,
            "simulation"};
}
bool ended(const KeptJob& job) {
    return job.end.has_value();
}

}  // namespace

const Made* Model::before(const std::string& person, const std::string& request) const {
    const auto answers = m_answers.find(person);
    if (answers == m_answers.end()) return nullptr;
    for (const Answer& answer : answers->second)
        if (answer.request == request) return &answer.made;
    return nullptr;
}

void Model::remember(const std::string& person, const std::string& request, Made made) {
    made.anew = false;
    if (before(person, request) == nullptr) m_answers[person].push_back({request, std::move(made)});
    if (m_answers[person].size() > 1000) m_answers[person].pop_front();
}

void Model::drop_acknowledged(Session& session) {
    Number layout = 0, phase = 0;
    for (const Event& event : session.events) {
        if (event.kind == EventKind::layout) layout = event.seq;
        if (event.kind == EventKind::phase) phase = event.seq;
    }
    std::erase_if(session.events, [&](const Event& event) {
        return event.seq <= session.kept.acknowledged && event.seq != layout && event.seq != phase &&
               event.kind != EventKind::ended;
    });
}

std::string Model::add_session(const Operation& operation) {
    if (const Made* const known = before(operation.person, operation.request)) return text(*known);
    Session session;
    const NewSession wanted = session_of(operation);
    session.kept.number = ++m_last_session;
    session.kept.person = wanted.person;
    session.kept.request = wanted.request;
    session.kept.title = wanted.title;
    session.task = {wanted.document, wanted.simulation};
    const Made made{m_last_session, answer_to(operation)(m_last_session), true};
    remember(operation.person, operation.request, made);
    m_sessions[m_last_session] = std::move(session);
    return text(made);
}

std::string Model::add_job(const Operation& operation) {
    if (const Made* const known = before(operation.person, operation.request)) return text(*known);
    Job job;
    const NewJob wanted = job_of(operation);
    job.kept.number = ++m_last_job;
    job.kept.person = wanted.person;
    job.kept.request = wanted.request;
    job.kept.title = wanted.title;
    job.task = {wanted.document, wanted.simulation};
    const Made made{m_last_job, answer_to(operation)(m_last_job), true};
    remember(operation.person, operation.request, made);
    m_jobs[m_last_job] = std::move(job);
    return text(made);
}

std::string Model::add_events(const Operation& operation) {
    Session session = m_sessions.at(operation.number);
    for (const Event& event : operation.events) {
        if (event.seq >= 1 && event.seq <= session.kept.last_seq) {
            const auto same = std::find_if(session.events.begin(), session.events.end(),
                                           [&](const Event& kept) { return kept.seq == event.seq; });
            if (same != session.events.end() && *same != event) return usage;
            continue;
        }
        if (session.kept.ended || event.seq != session.kept.last_seq + 1) return usage;
        session.kept.last_seq = event.seq;
        session.kept.ended = event.kind == EventKind::ended;
        session.events.push_back(event);
    }
    for (const Dated& dated : operation.dated) {
        if (dated.change < 1 || dated.change > session.changes.size()) return usage;
        auto& step = session.changes[dated.change - 1].step;
        if (step && *step != dated.step) return usage;
        step = dated.step;
        session.changes[dated.change - 1].flip_told |= dated.flip_told;
    }
    drop_acknowledged(session);
    m_sessions[operation.number] = std::move(session);
    return "done";
}

std::string Model::add_change(const Operation& operation) {
    Session& session = m_sessions.at(operation.number);
    if (const Made* const known = before(session.kept.person, operation.request)) return text(*known);
    const Number number = session.changes.size() + 1;
    session.changes.push_back({number, operation.request, operation.text, {}});
    const Made made{number, answer_to(operation)(number), true};
    remember(session.kept.person, operation.request, made);
    return text(made);
}

std::string Model::of_session(const Operation& operation, Session& session) {
    switch (operation.kind) {
        case Kind::change_session:
            session.kept.state = operation.state;
            return "done";
        case Kind::add_events:
            return add_events(operation);
        case Kind::add_change:
            return add_change(operation);
        case Kind::acknowledge:
            if (operation.other > session.kept.last_seq) return usage;
            session.kept.acknowledged = std::max(session.kept.acknowledged, operation.other);
            drop_acknowledged(session);
            return "done";
        default:
            return text(session.kept.last_seq - session.kept.acknowledged);
    }
}

std::string Model::of_job(const Operation& operation, Job& job) {
    switch (operation.kind) {
        case Kind::start_job:
            if (ended(job.kept)) return usage;
            if (job.kept.phase == JobPhase::waiting) ++job.kept.attempts;
            job.kept.phase = JobPhase::running;
            return "done";
        case Kind::end_job:
            if (ended(job.kept)) return *job.kept.end == operation.end ? "done" : usage;
            job.kept.phase = operation.end.phase;
            job.kept.end = operation.end;
            return "done";
        default:
            return usage;
    }
}

std::string Model::apply(const Operation& operation) {
    const auto session = m_sessions.find(operation.number);
    const auto job = m_jobs.find(operation.number);
    switch (operation.kind) {
        case Kind::remember:
            remember(operation.person, operation.request, {0, operation.text, true});
            return "done";
        case Kind::answer_of: {
            const Made* const known = before(operation.person, operation.request);
            return text(known != nullptr ? std::optional(known->answer) : std::nullopt);
        }
        case Kind::add_session:
            return add_session(operation);
        case Kind::add_job:
            return add_job(operation);
        case Kind::forget_session:
            m_sessions.erase(operation.number);
            return "done";
        case Kind::forget_job:
            if (job != m_jobs.end() && !ended(job->second.kept)) return usage;
            m_jobs.erase(operation.number);
            return "done";
        case Kind::events_after: {
            std::vector<Event> found;
            if (session != m_sessions.end())
                for (const Event& event : session->second.events)
                    if (event.seq > operation.other && found.size() < 3) found.push_back(event);
            return text(found);
        }
        case Kind::job_progress:
            if (job != m_jobs.end() && job->second.kept.phase == JobPhase::running) {
                job->second.kept.step = operation.other;
                job->second.kept.residual = 0.5;
            }
            return "done";
        case Kind::start_job:
        case Kind::end_job:
            return job == m_jobs.end() ? usage : of_job(operation, job->second);
        default:
            return session == m_sessions.end() ? usage : of_session(operation, session->second);
    }
}

void Model::reopen() {
    for (auto& [number, job] : m_jobs) {
        if (job.kept.phase != JobPhase::running) continue;
        job.kept.phase = JobPhase::waiting;
        job.kept.step = 0;
        job.kept.residual.reset();
    }
}

std::string Model::told() const {
    std::string all;
    for (const auto& [number, session] : m_sessions)
        all += text(session.kept) + "\n" + text(session.task) + "\n" + text(session.events) +
               text(session.changes);
    for (const auto& [number, job] : m_jobs) all += text(job.kept) + "\n" + text(job.task) + "\n";
    for (const std::string& person : people)
        for (std::size_t k = 0; k < request_count; ++k)
            if (const Made* const known = before(person, request_of(k))) all += text(known->answer);
    return all;
}

std::string told(Store& store) {
    const auto read = [&]() -> Result<std::string> {
        std::string all;
        WEAVE_TRY(const auto sessions, store.sessions());
        for (const KeptSession& session : sessions) {
            WEAVE_TRY(const SessionTask task, store.task_of_session(session.number));
            WEAVE_TRY(const auto events, store.events_after(session.number, 0, SIZE_MAX));
            WEAVE_TRY(const auto changes, store.changes(session.number));
            all += text(session) + "\n" + text(task) + "\n" + text(events) + text(changes);
        }
        WEAVE_TRY(const auto jobs, store.jobs());
        for (const KeptJob& job : jobs) {
            WEAVE_TRY(const JobTask task, store.task_of_job(job.number));
            all += text(job) + "\n" + text(task) + "\n";
        }
        for (const std::string& person : people)
            for (std::size_t k = 0; k < request_count; ++k) {
                WEAVE_TRY(const auto answer, store.answer_of(person, request_of(k)));
                if (answer) all += text(*answer);
            }
        return all;
    };
    const auto all = read();
    return all ? *all : "fails: " + all.error().text();
}

std::string apply(Store& store, const Operation& operation) {
    switch (operation.kind) {
        case Kind::remember:
            return outcome(store.remember(operation.person, operation.request, operation.text));
        case Kind::answer_of:
            return outcome(store.answer_of(operation.person, operation.request));
        case Kind::add_session:
            return outcome(store.add_session(session_of(operation), answer_to(operation)));
        case Kind::change_session:
            return outcome(store.change_session(operation.number, operation.state));
        case Kind::forget_session:
            return outcome(store.forget_session(operation.number));
        case Kind::add_events:
            return outcome(store.add_events(operation.number, operation.events, operation.dated));
        case Kind::events_after:
            return outcome(store.events_after(operation.number, operation.other, 3));
        case Kind::acknowledge:
            return outcome(store.acknowledge(operation.number, operation.other));
        case Kind::add_change:
            return outcome(
                store.add_change(operation.number, operation.request, operation.text, answer_to(operation)));
        case Kind::add_job:
            return outcome(store.add_job(job_of(operation), answer_to(operation)));
        case Kind::start_job:
            return outcome(store.start_job(operation.number));
        case Kind::job_progress:
            store.job_progress(operation.number, operation.other, 0.5);
            return "done";
        case Kind::end_job:
            return outcome(store.end_job(operation.number, operation.end));
        case Kind::forget_job:
            return outcome(store.forget_job(operation.number));
    }
    return {};
}

Operation Model::random(Random& random) const {
    Operation made;
    made.kind = static_cast<Kind>(random.between(0, Operation::kinds - 1));
    made.person = people[random.between(0, people.size() - 1)];
    made.request = request_of(random.between(0, request_count - 1));
    made.text =
        "text " + std::to_string(random.between(0, 1'000'000)) + std::string(random.between(0, 3000), 'x');
    const bool of_job = made.kind >= Kind::add_job;
    const Number last = of_job ? m_last_job : m_last_session;
    made.number = random.between(last > 3 ? last - 3 : 0, last + (random.between(0, 9) == 0 ? 1 : 0));
    made.state = {"running",
                  random.between(0, 999),
                  random.coin() ? std::optional<Number>(random.between(0, 999)) : std::nullopt,
                  random.between(0, 99),
                  random.between(0, 9),
                  random.between(0, 99)};
    made.end = {static_cast<JobPhase>(random.between(2, 4)), {}, "report", {}, {}};
    if (random.coin()) made.end.error = "error";
    if (random.coin()) made.end.evidence = made.text;
    if (random.coin()) made.end.yarns = "job.yarns";
    const auto session = m_sessions.find(made.number);
    const Number last_seq = session == m_sessions.end() ? 0 : session->second.kept.last_seq;
    made.other =
        random.between(last_seq > 5 ? last_seq - 5 : 0, last_seq + (random.between(0, 9) == 0 ? 1 : 0));
    Number seq = last_seq + 1;
    if (random.between(0, 4) == 0) seq = random.between(last_seq > 2 ? last_seq - 2 : 0, last_seq + 2);
    for (std::size_t k = random.between(0, 3); k > 0; --k) {
        const bool last_one = random.between(0, 40) == 0;
        made.events.push_back({seq,
                               last_one ? EventKind::ended : static_cast<EventKind>(random.between(0, 2)),
                               "event " + std::to_string(random.between(0, 3))});
        ++seq;
    }
    if (session != m_sessions.end() && !session->second.changes.empty() && random.coin())
        made.dated.push_back({random.between(1, session->second.changes.size()), random.between(0, 2), random.between(0, 1) == 1});
    return made;
}

}  // namespace weave::simd::testing
