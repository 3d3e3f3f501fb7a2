#pragma once

#include "box.hpp"

#include <map>
#include <simd/service/local_tokens.hpp>
#include <string>

namespace weave::simd::testing {

/// A daemon that several people reach over TCP, each by a token of the daemon's own.
class People {
  public:
    explicit People(Json config = Json::object()) : m_box(over_tcp(std::move(config))) {}

    [[nodiscard]] const Box& box() const { return m_box; }
    [[nodiscard]] std::string url() const { return m_box.introduction.at("url"); }
    [[nodiscard]] std::filesystem::path tokens() const { return m_box.folder() / "tokens"; }
    /// Where the daemon is, without a token.
    [[nodiscard]] wire::ServerPlace place() const { return wire::place_of(url()).value(); }
    /// The same with a token.
    [[nodiscard]] wire::ServerPlace place_with(const std::string& token) const {
        wire::ServerPlace where = place();
        REQUIRE(wire::use_token(where, token));
        return where;
    }
    /// As this person, who gets a token if there is none yet.
    [[nodiscard]] wire::ServerPlace place(const std::string& person) const {
        if (!m_tokens.contains(person)) m_tokens[person] = add_local_token(tokens(), person).value();
        return place_with(m_tokens.at(person));
    }
    [[nodiscard]] wire::Follower follower(const std::string& person) const {
        auto follower = wire::Follower::connect(place(person), "test", 60s);
        INFO((follower ? "" : follower.error().text()));
        REQUIRE(follower);
        return std::move(*follower);
    }

  private:
    static Json over_tcp(Json config) {
        config["address"] = "127.0.0.1";
        config["port"] = 0;
        config["plain"] = true;
        return config;
    }

    Box m_box;
    mutable std::map<std::string, std::string> m_tokens;
};

}  // namespace weave::simd::testing
