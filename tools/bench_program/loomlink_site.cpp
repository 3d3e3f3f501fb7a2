#include "loomlink_site.hpp"

#include <atomic>
#include <chrono>
#include <csignal>
#include <stdexcept>
#include <thread>

namespace weave::bench {

namespace {

std::string text_of(const net::Response& response) {
    return response.body ? *response.body : "";
}

std::string next_request() {
    static std::atomic<int> count{0};
    return "bench-request-" + std::to_string(++count);
}

}  // namespace

Result<net::Response> LoomlinkSite::Person::ask(const std::string& method, const std::string& path,
                                                Json body) {
    net::ClientRequest request{method, "/api/v1" + path, {}, {}};
    if (!m_token.empty()) request.headers.set("Authorization", "Bearer " + m_token);
    if (method != "GET") {
        if (!body.contains("request")) body["request"] = next_request();
        request.headers.set("Content-Type", "application/json");
        request.body = body.dump();
    }
    return m_client.send(request);
}

Json LoomlinkSite::Person::done(const std::string& method, const std::string& path, const Json& body) {
    Json wish = body;
    if (method != "GET" && !wish.contains("request")) wish["request"] = next_request();
    auto answer = ask(method, path, wish);
    // The service closes connections that nobody used for a while; the same request again does nothing twice.
    if (!answer) answer = ask(method, path, wish);
    if (!answer) throw std::runtime_error(path + ": " + answer.error().text());
    if (answer->status != 200)
        throw std::runtime_error(path + ": " + std::to_string(answer->status) + " " + text_of(*answer));
    return parse_json(text_of(*answer)).value();
}

LoomlinkSite::LoomlinkSite() {
    const auto link = spawn().at("invitation").get<std::string>();
    m_tokens.emplace_back("admin", accept(link.substr(link.find('#') + 1), "admin"));
    m_people.push_back(again("admin"));
    Json policy = administrator().done("GET", "/policy");
    policy["simulation"] = "optional";
    administrator().done("PUT", "/policy", policy);
}

Json LoomlinkSite::spawn() {
    const std::vector<std::string> words{"serve",  (m_folder.path() / "site").string(), "--port", "0",
                                         "--host", "127.0.0.1",                         "--json"};
    m_program.emplace("loomlink", words, m_folder.path() / "told.txt");
    const Json& told = m_program->introduction();
    m_options = net::parse_origin(told.at("url").get<std::string>()).value();
    m_options.answer_time = std::chrono::minutes(5);  // a busy machine is measured, not given up
    m_options.tls = net::Trust{{}, told.at("certificate_sha256").get<std::string>()};
    return told;
}

void LoomlinkSite::start() {
    spawn();
    m_people.clear();
    m_people.push_back(again("admin"));
}

std::uintmax_t LoomlinkSite::stop_and_measure() {
    if (m_program->end(SIGTERM) != 0) throw std::runtime_error("loomlink did not end in good order");
    std::uintmax_t bytes = 0;
    for (const auto& entry : std::filesystem::directory_iterator(m_folder.path() / "site"))
        if (entry.path().filename().string().starts_with("loomlink.db")) bytes += entry.file_size();
    return bytes;
}

std::string LoomlinkSite::accept(const std::string& code, const std::string& name) const {
    Person nobody(m_options, "");
    const Json body{{"code", code}, {"name", name}, {"full_name", "The " + name}, {"password", password}};
    while (true) {
        const auto answer = nobody.ask("POST", "/invitations/accept", body);
        if (!answer) throw std::runtime_error(name + " cannot join: " + answer.error().text());
        if (answer->status == 200) return parse_json(text_of(*answer)).value().at("token").get<std::string>();
        if (answer->status != 429) throw std::runtime_error(name + " cannot join: " + text_of(*answer));
        std::this_thread::sleep_for(std::chrono::seconds(1));
    }
}

LoomlinkSite::Person LoomlinkSite::join(const std::string& name, const std::string& role) {
    const Json invitation = administrator().done("POST", "/invitations", {{"roles", Json::array({role})}});
    m_tokens.emplace_back(name, accept(invitation.at("code").get<std::string>(), name));
    return again(name);
}

LoomlinkSite::Person LoomlinkSite::again(const std::string& name) const {
    for (const auto& [who, token] : m_tokens)
        if (who == name) return Person(m_options, token);
    throw std::runtime_error("nobody is called " + name);
}

}  // namespace weave::bench
