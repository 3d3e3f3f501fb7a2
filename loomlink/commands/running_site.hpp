#pragma once

#include <weave/core/json.hpp>
#include <weave/core/result.hpp>

#include <cstdint>
#include <loomlink/commands/config.hpp>
#include <loomlink/commands/site_folder.hpp>
#include <loomlink/workflow/desk.hpp>
#include <memory>

namespace weave::loomlink {

/// Whether what the configuration names is there and can be had: as of check_service_places(), and a folder for the
/// heads. Errors name the member.
Status check_places(const ServeConfig& config);

/// A site with its service. Ends with the object.
class RunningSite {
  public:
    /// Opens or makes the site, and serves it. Errors as of open_site(), tls_of() and net::Server::start().
    static Result<std::unique_ptr<RunningSite>> start(const SiteFolder& folder, const ServeConfig& config,
                                                      const DeskSettings& settings = {});
    ~RunningSite();
    RunningSite(const RunningSite&) = delete;
    RunningSite& operator=(const RunningSite&) = delete;

    [[nodiscard]] std::uint16_t port() const;
    /// What people need to come in: `site`, `url`, `made_in` (the folder, where the site is new),
    /// `certificate_sha256` (with TLS), `trust_sha256` (once there is a trust document), `access_public` (by
    /// what simd knows access tokens), and `invitation`, a
    /// link for the first administrator, while nobody has joined. Each call makes a new invitation.
    [[nodiscard]] Result<Json> introduction();
    /// Takes nothing new, and lets what runs finish.
    void stop();

  private:
    struct Parts;
    explicit RunningSite(std::unique_ptr<Parts> parts);
    std::unique_ptr<Parts> m_parts;
};

}  // namespace weave::loomlink
