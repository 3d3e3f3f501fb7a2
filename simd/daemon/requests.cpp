#include <algorithm>
#include <simd/daemon/daemon.hpp>
#include <type_traits>
#include <utility>

namespace weave::simd {

namespace {

Error no_such_session(std::uint64_t number) {
    return {ErrorCode::refused, "there is no such session", "session " + std::to_string(number)};
}

/// The title of a document, for lists; its design is read by the worker alone.
Result<std::string> title_of(const std::string& document) {
    constexpr std::size_t longest = 1000;
    auto json = parse_json(document);
    if (!json) return std::move(json).error().in("document");
    if (!json->is_object()) return bad_input("is no design", "document");
    const auto title = json->find("title");
    if (title == json->end() || !title->is_string()) return std::string();
    std::string text = title->get<std::string>();
    if (text.size() <= longest) return text;
    std::size_t end = longest;  // not within a character
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0U) == 0x80U) --end;
    return text.substr(0, end);
}

}  // namespace

/// A request that was answered before, be it over another connection, is answered the same way and done no second time. So is
/// one that comes too soon after many others, but it may come again. Where the disk fails, what needs none may be done twice.
bool Daemon::answered_before(const ClientPtr& client, const std::string& request, bool needs_disk) {
    const auto answer = m_store->answer_of(client->person(), request);
    if (!answer && needs_disk) {
        client->tell(wire::Refused{request, {ErrorCode::system, "the disk does not take it: " + answer.error().message, ""}, {}});
        return true;
    }
    if (answer && *answer) {
        client->tell(net::make_bytes(**answer));
        return true;
    }
    if (m_requests.take(client->person())) {
        client->impatient = 0;
        return false;
    }
    constexpr std::size_t most_impatient = 100;  // who does not even slow down when told to costs others their time
    if (++client->impatient >= most_impatient) client->throw_out("too many requests in a short time");
    client->tell(wire::Refused{request, {ErrorCode::refused, "too many requests in a short time: at most 30 a second in the long run", ""}, 1.0});
    return true;
}

template <class Message, class Do>
void Daemon::with_session(const ClientPtr& client, const Message& message, Do what) {
    Session* const session = session_of(client->person(), message.session);
    if (session == nullptr) return client->tell(wire::Refused{message.request, no_such_session(message.session), {}});
    what(*session);
}

void Daemon::obey(const ClientPtr& client, const wire::ClientMessage& message) {
    if (const auto* submit = std::get_if<wire::Submit>(&message)) {
        const auto title = title_of(submit->document);  // large ones take a while: before the lock
        if (!title) return client->tell(wire::Refused{submit->request, title.error(), {}});
        const std::lock_guard lock(m_lock);
        return this->submit(client, *submit, *title);
    }
    const std::lock_guard lock(m_lock);
    std::visit([&](const auto& one) { obey_one(client, one); }, message);
}

template <class Message>
void Daemon::obey_one(const ClientPtr& client, const Message& message) {
    constexpr bool changes_something = std::is_same_v<Message, wire::Create> || std::is_same_v<Message, wire::Run> || std::is_same_v<Message, wire::Pause> ||
                                       std::is_same_v<Message, wire::Step> || std::is_same_v<Message, wire::MakeChange> ||
                                       std::is_same_v<Message, wire::Checkpoint> || std::is_same_v<Message, wire::Close> ||
                                       std::is_same_v<Message, wire::Cancel>;
    if constexpr (changes_something) {
        constexpr bool needs_disk = !std::is_same_v<Message, wire::Pause>;
        if (answered_before(client, message.request, needs_disk)) return;
    }
    const auto in_session = [&](auto what) { with_session(client, message, what); };
    if constexpr (std::is_same_v<Message, wire::Create>) create(client, message);
    else if constexpr (std::is_same_v<Message, wire::Attach>) attach(client, message);
    else if constexpr (std::is_same_v<Message, wire::Run>) in_session([&](Session& session) { session.go_on(client, message.request, {}); });
    else if constexpr (std::is_same_v<Message, wire::Step>) in_session([&](Session& session) { session.go_on(client, message.request, message.steps); });
    else if constexpr (std::is_same_v<Message, wire::Pause>) in_session([&](Session& session) { session.pause(client, message.request); });
    else if constexpr (std::is_same_v<Message, wire::MakeChange>) in_session([&](Session& session) { session.change(client, message); });
    else if constexpr (std::is_same_v<Message, wire::ReadState>) in_session([&](Session& session) { session.read_state(client, message.request); });
    else if constexpr (std::is_same_v<Message, wire::Checkpoint>) in_session([&](Session& session) { session.checkpoint(client, message.request); });
    else if constexpr (std::is_same_v<Message, wire::Close>) in_session([&](Session& session) { session.close(client, message.request); });
    else if constexpr (std::is_same_v<Message, wire::WantFrames>) in_session([&](Session& session) { session.want_frames(client, message); });
    else if constexpr (std::is_same_v<Message, wire::Acknowledge>) {
        if (Session* const session = session_of(client->person(), message.session)) session->acknowledge(message.seq);
    } else if constexpr (std::is_same_v<Message, wire::ListSessions>) list_sessions(client, message.request);
    else if constexpr (std::is_same_v<Message, wire::ListJobs>) list_jobs(client, message.request);
    else if constexpr (std::is_same_v<Message, wire::Cancel>) cancel(client, message);
    else if constexpr (std::is_same_v<Message, wire::AcknowledgeJob>) acknowledge_job(client, message.job);
    else if constexpr (std::is_same_v<Message, wire::Hello>)
        client->tell(wire::Refused{{}, {ErrorCode::usage, "was said before", "hello"}, {}});
}

// ---- Sessions ----

/// Or will, once what it asked for is planned.
bool Daemon::serves_a_session(const ClientPtr& client) const {
    return client->session != 0 || std::ranges::any_of(m_sessions, [&](const auto& session) { return session->is_awaited_by(client); });
}

void Daemon::create(const ClientPtr& client, const wire::Create& create) {
    const auto refuse = [&](std::string message, std::optional<double> wait_s = {}) {
        client->tell(wire::Refused{create.request, {ErrorCode::refused, std::move(message), "create"}, wait_s});
    };
    for (const auto& session : m_sessions) {  // asked again while it is being planned
        if (!session->is_accepted() && session->person() == client->person() && session->request() == create.request)
            return session->wait_for_creation(client);
    }
    if (serves_a_session(client)) return refuse("this connection serves a session already: use another one");
    if (m_is_stopping) return refuse("the server is being stopped");
    const auto lives = [](const auto& session) { return !session->has_ended(); };
    const auto own = [&](const auto& session) { return !session->has_ended() && session->person() == client->person(); };
    if (static_cast<std::size_t>(std::ranges::count_if(m_sessions, own)) >= m_settings.sessions_per_person)
        return refuse("you have " + std::to_string(m_settings.sessions_per_person) + " sessions, as many as one person may: close one");
    constexpr std::size_t most_kept = 200;  // of one person, with those whose end nobody has acknowledged yet
    const auto kept = [&](const auto& session) { return session->person() == client->person(); };
    if (static_cast<std::size_t>(std::ranges::count_if(m_sessions, kept)) >= most_kept)
        return refuse("the ends of so many of your sessions are not acknowledged that there is no room for another: acknowledge some");
    if (static_cast<std::size_t>(std::ranges::count_if(m_sessions, lives)) >= m_settings.most_sessions)
        return refuse("this machine has as many sessions as it may", expected_wait_s());
    m_sessions.push_back(std::make_unique<Session>(around_session(), create, client));
}

void Daemon::attach(const ClientPtr& client, const wire::Attach& attach) {
    if (serves_a_session(client))
        return client->tell(wire::Refused{attach.request, {ErrorCode::refused, "this connection serves a session already: use another one", "attach"}, {}});
    with_session(client, attach, [&](Session& session) { session.attach(client, attach); });
}

void Daemon::list_sessions(const ClientPtr& client, const std::string& request) {
    wire::SessionList list{request, {}};
    for (const auto& session : m_sessions) {
        if (session->is_accepted() && session->person() == client->person() && !session->is_over()) list.sessions.push_back(session->summary(m_settings.expire));
    }
    client->tell(list);
}

// ---- Jobs ----

void Daemon::submit(const ClientPtr& client, const wire::Submit& submit, const std::string& title) {
    if (answered_before(client, submit.request, true)) return;
    const auto refuse = [&](Error error) { client->tell(wire::Refused{submit.request, std::move(error), {}}); };
    if (m_is_stopping) return refuse({ErrorCode::refused, "the server is being stopped", "submit"});
    const auto own = [&](const auto& job) { return job->person() == client->person(); };
    if (static_cast<std::size_t>(std::ranges::count_if(m_jobs, own)) >= m_settings.jobs_per_person)
        return refuse({ErrorCode::refused, "you have " + std::to_string(m_settings.jobs_per_person) + " jobs here, as many as one person may", "submit"});
    const Outlook outlook = this->outlook();
    const std::optional<double> wait_s = outlook.wait_s(outlook.places.size() + 1);
    const auto text = [&](std::uint64_t number) { return wire::write_message(wire::Accepted{submit.request, {}, number, wait_s}); };
    const NewJob fresh{client->person(), submit.request, title, submit.document, simulation_text(submit.simulation, submit.flips)};
    const auto made = m_store->add_job(fresh, text);
    if (!made) return refuse({ErrorCode::system, "the disk does not take it: " + made.error().message, "submit"});
    const KeptJob kept{.number = made->number, .person = fresh.person, .request = fresh.request, .title = fresh.title, .residual = {}, .end = {}};
    m_jobs.push_back(std::make_unique<Job>(around_job(), kept));
    client->tell(net::make_bytes(made->answer));
}

void Daemon::list_jobs(const ClientPtr& client, const std::string& request) {
    wire::JobList list{request, {}, m_settings.sign != nullptr};
    const Outlook outlook = this->outlook();
    for (const auto& job : m_jobs) {
        if (job->person() == client->person()) list.jobs.push_back(told_state(*job, outlook));
    }
    client->tell(list);
}

void Daemon::cancel(const ClientPtr& client, const wire::Cancel& cancel) {
    const auto refuse = [&](std::string message) {
        client->tell(wire::Refused{cancel.request, {ErrorCode::refused, std::move(message), "job " + std::to_string(cancel.job)}, {}});
    };
    Job* const job = job_of(client->person(), cancel.job);
    if (job == nullptr) return refuse("there is no such job");
    if (job->is_over()) return refuse("has ended");
    const std::string text = wire::write_message(wire::Accepted{cancel.request, {}, {}, {}});
    if (!m_store->remember(client->person(), cancel.request, text)) return refuse("the disk does not take it");
    client->tell(net::make_bytes(text));
    job->cancel();
}

void Daemon::acknowledge_job(const ClientPtr& client, std::uint64_t number) {
    Job* const job = job_of(client->person(), number);
    if (job == nullptr || !job->is_over()) return;
    if (!m_store->forget_job(number)) return;  // it is told again, and may be acknowledged then
    std::erase_if(m_jobs, [&](const auto& one) { return one.get() == job; });
    std::error_code ignored;
    std::filesystem::remove_all(m_settings.folder / "jobs" / std::to_string(number), ignored);
}

}  // namespace weave::simd
