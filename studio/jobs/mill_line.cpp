#include <studio/jobs/mill_line.hpp>

#include <utility>

namespace weave::studio {

MillLine::MillLine(std::filesystem::path session_file)
    : m_file(std::move(session_file)), m_thread([this] { work(); }) {}

MillLine::~MillLine() {
    m_closes = true;
    {
        const std::lock_guard lock(m_mutex);
        m_ends = true;
        m_calls.clear();
    }
    m_came.notify_all();
    m_thread.join();
}

void MillLine::add(Errand errand, std::function<void(const Status&, MillLine&)> ended) {
    {
        const std::lock_guard lock(m_mutex);
        m_calls.push_back({std::move(errand), std::move(ended), ++m_added});
    }
    m_came.notify_all();
}

void MillLine::give_up() {
    const std::lock_guard lock(m_mutex);
    m_given_up = m_added;
}

void MillLine::work() {
    for (;;) {
        Call call;
        {
            std::unique_lock lock(m_mutex);
            m_came.wait(lock, [this] { return m_ends || !m_calls.empty(); });
            if (m_ends) return;
            call = std::move(m_calls.front());
            m_calls.pop_front();
        }
        m_now = call.number;
        const Status status = is_given_up() ? Status(Error{ErrorCode::refused, "this was given up", ""}) : run(call.errand);
        m_told = nullptr;
        if (!m_closes) call.ended(status, *this);
    }
}

Status MillLine::run(const Errand& errand) {
    Status status = errand(*this);
    if (status || !m_client || !m_client->is_signed_out()) return status;
    auto kept = wire::load_session(m_file);
    if (!kept || kept->token.empty() || kept->token == m_session.token) return status;
    use(*std::move(kept));  // somebody signed in anew beside the studio
    return errand(*this);
}

Result<wire::MillClient*> MillLine::client() {
    if (!m_client) return Error{ErrorCode::refused, "nobody is signed in", ""};
    return &*m_client;
}

Status MillLine::read_session() {
    WEAVE_TRY(wire::MillSession kept, wire::load_session(m_file));
    use(std::move(kept));
    return {};
}

void MillLine::use(wire::MillSession session) {
    m_session = std::move(session);
    m_client.reset();
    if (m_session.token.empty()) return;
    if (auto client = wire::MillClient::of(m_session)) m_client.emplace(*std::move(client));
    if (m_client) tend(*m_client);
}

Status MillLine::adopt(wire::MillClient client) {
    m_session = client.session();
    m_client.emplace(std::move(client));
    tend(*m_client);
    return wire::save_session(m_file, m_session);
}

Status MillLine::forget() {
    m_client.reset();
    m_session.token.clear();
    return wire::save_session(m_file, m_session);
}

void MillLine::tend(wire::MillClient& client) {
    client.report_to([this](std::size_t sent, std::size_t of) {
        if (m_told && of > 0) m_told(sent, of);
        return !is_given_up() && !m_closes;
    });
}

}  // namespace weave::studio
