#include <simd/service/visitors.hpp>

#include <weave/core/log.hpp>
#include <weave/keys/access_token.hpp>
#include <weave/keys/codes.hpp>

#include <simd/service/local_tokens.hpp>
#include <string_view>

namespace weave::simd {

namespace {

/// The one bearer token that a request shows; nothing where it shows none, or two.
std::optional<std::string> shown_token(const net::Request& request) {
    constexpr std::string_view scheme = "Bearer ";
    std::optional<std::string> token;
    for (const auto& [name, value] : request.headers) {
        if (!net::equal_without_case(name, "Authorization")) continue;
        if (token || value.size() > most_access_token + scheme.size()) return {};
        if (!net::equal_without_case(std::string_view(value).substr(0, scheme.size()), scheme)) return {};
        token = value.substr(scheme.size());
    }
    return token;
}

}  // namespace

Result<Visitor> Doorkeeper::let_in(const net::Request& request) {
    if (request.local) return Visitor{local_person_name, {}, true};
    const std::optional<std::string> token = shown_token(request);
    if (token) {  // one that counts gets in, whatever others tried from the same address: none can be guessed
        if (auto visitor = visitor_of(*token)) return std::move(*visitor);
        if (!m_wrong.take(request.peer)) return Error{ErrorCode::refused, "too many tokens that do not count: wait a little", "Authorization"};
    }
    return Error{ErrorCode::refused, token ? "this token does not count here, or no longer: get a new one" : "show a token: Authorization: Bearer …", "Authorization"};
}

std::optional<Visitor> Doorkeeper::visitor_of(const std::string& token) {
    if (const auto person = local_person(token_hash(token)))
        return Visitor{*person, [this, hash = token_hash(token), person = *person] { return local_person(hash) == person; }, false};
    const auto read = read_access_token(token, m_rules.keys, std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now()));
    if (!read || read->person == local_person_name) return {};
    if (!m_rules.site.empty() && read->site != m_rules.site) return {};
    return Visitor{read->person, [until = read->expires] { return std::chrono::system_clock::now() < until; }, false};
}

std::optional<std::string> Doorkeeper::local_person(const std::string& hash) {
    const std::lock_guard lock(m_mutex);
    read_file();
    const auto found = m_people.find(hash);  // of a hash, so how long it takes tells nothing of a token
    if (found == m_people.end()) return {};
    return found->second;
}

/// Anew where it has changed: a token that was taken away counts no more.
void Doorkeeper::read_file() {
    std::error_code missing;
    const auto written = std::filesystem::last_write_time(m_rules.file, missing);
    if (missing) {
        m_people.clear();
        m_read = {};
        return;
    }
    if (written == m_read) return;
    auto people = read_local_tokens(m_rules.file);
    if (!people) log(LogLevel::warning, people.error().text());
    m_people = people ? std::move(*people) : std::map<std::string, std::string>{};
    // What was written just now may be written again within the same tick of the clock.
    const bool has_settled = std::filesystem::file_time_type::clock::now() - written > std::chrono::seconds(1);
    m_read = has_settled ? written : std::filesystem::file_time_type{};
}

}  // namespace weave::simd
