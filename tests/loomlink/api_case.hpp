#pragma once

#include "service_case.hpp"
#include "store_places.hpp"

#include <weave/core/file.hpp>

#include <loomlink/commands/running_site.hpp>
#include <loomlink/keys/argon.hpp>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <support/temporary_folder.hpp>

namespace weave::loomlink::testing {

inline const std::string api_password = "warp and weft and warp";

/// A site on a port of its own, and people who talk to it as programs do. Guessing a password costs next to
/// nothing, so that signing does not take all the time.
struct ApiMill {
    weave::testing::TemporaryFolder folder;
    Folder stores;
    std::unique_ptr<RunningSite> site;
    Json introduction;
    std::optional<net::HttpClient> client;
    std::map<std::string, std::string> tokens;
    int requests = 0;

    /// Over TLS, or plain.
    explicit ApiMill(bool plain = false) : m_plain(plain) { start(); }

    void start() {
        ServeConfig config;
        if (stores_are_on_server()) config.store = stores.store("site");
        config.port = 0;
        config.hosts = {"localhost", "127.0.0.1"};
        config.plain = m_plain;
        DeskSettings settings;
        settings.key_cost = settings.login_cost = test_cost();
        auto started = RunningSite::start({folder.path / "site"}, config, settings);
        if (!started) FAIL(started.error().text());
        site = *std::move(started);
        introduction = site->introduction().value();
        client.emplace(options());
    }

    [[nodiscard]] net::ClientOptions options() const {
        net::ClientOptions options;
        options.port = site->port();
        if (!m_plain) options.tls = net::Trust{{}, introduction.at("certificate_sha256").get<std::string>()};
        return options;
    }

    net::Response call(const std::string& who, const std::string& method, const std::string& path,
                       Json body = {}) {
        net::Headers headers;
        if (tokens.contains(who)) headers.set("Authorization", "Bearer " + tokens[who]);
        std::string text;
        if (method != "GET") {
            if (!body.contains("request")) body["request"] = "request-" + std::to_string(++requests);
            headers.set("Content-Type", "application/json");
            text = body.dump();
        }
        return ask(*client, method, "/api/v1" + path, headers, text);
    }
    /// The answer of a call that must succeed.
    Json done(const std::string& who, const std::string& method, const std::string& path,
              const Json& body = {}) {
        const auto response = call(who, method, path, body);
        INFO(who << " " << method << " " << path << ": " << *response.body);
        REQUIRE(response.status == 200);
        return json_of(response);
    }
    int status(const std::string& who, const std::string& method, const std::string& path,
               const Json& body = {}) {
        return call(who, method, path, body).status;
    }

    void join(const std::string& code, const std::string& name) {
        const Json answer =
            done("nobody", "POST", "/invitations/accept",
                 {{"code", code}, {"name", name}, {"full_name", "The " + name}, {"password", api_password}});
        tokens[name] = answer.at("token").get<std::string>();
    }
    void invite(const std::string& name, const Json& roles) {
        join(done("mary", "POST", "/invitations", {{"roles", roles}}).at("code").get<std::string>(), name);
    }
    [[nodiscard]] std::string first_code() const {
        const auto link = introduction.at("invitation").get<std::string>();
        return link.substr(link.find('#') + 1);
    }
    /// dora designs, abel approves, otto works at the loom seven, emil audits. No simulation is asked for.
    void people_and_a_loom() {
        join(first_code(), "mary");
        invite("dora", {"designer"});
        invite("abel", {"approver"});
        invite("otto", {"operator"});
        invite("emil", {"engineer"});
        Json policy = done("mary", "GET", "/policy");
        policy["simulation"] = "optional";
        done("mary", "PUT", "/policy", policy);
        done("mary", "POST", "/looms",
             {{"name", "seven"}, {"profile", read_file(WEAVE_SOURCE_DIR "/db/looms/tc2.json").value()}});
        done("mary", "PUT", "/looms/seven/operators", {{"operators", {"otto"}}});
        done("mary", "POST", "/trust", {{"password", api_password}});
    }

  private:
    bool m_plain;
};

}  // namespace weave::loomlink::testing
