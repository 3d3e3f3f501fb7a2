#include <weave/command/service_places.hpp>
#include <weave/core/text.hpp>

#include <loomlink/commands/command.hpp>
#include <loomlink/commands/site_folder.hpp>
#include <loomlink/workflow/workflow.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

namespace {

Status make_new_site(const SiteFolder& folder, const ServeConfig& config, CommandOutcome& outcome) {
    WEAVE_CHECK_OK(check_config(config));
    if (const Status hosts = check_hosts(config.hosts); !hosts) return bad_input(hosts.error().message, "--host");
    WEAVE_TRY(OpenSite site, open_site(folder, config));
    if (!site.is_new) return Error{ErrorCode::refused, "holds a site already", folder.path.string()};
    WEAVE_CHECK_OK(tls_of(folder.tls(), config));
    WEAVE_TRY(const auto certificate, net::read_certificate(folder.tls().certificate));
    const std::string name = site.name;
    WEAVE_TRY(const auto workflow, Workflow::open(std::move(site.store), std::move(site.keys)));
    WEAVE_TRY(const Json invitation, workflow->accounts().first_invitation());
    const std::string code = invitation.value("code", std::string());
    const std::string where = folder.whole_path();
    outcome.answer(
        {{"site", name}, {"made_in", where}, {"certificate_sha256", certificate.fingerprint}, {"code", code}},
        "Made the new, empty site " + name + " in " + on_one_line(where) + ".\ncertificate (SHA-256): " +
            certificate.fingerprint + "\nThe first administrator joins with this code, once: " + code +
            "\nServe it: loomlink serve " + on_one_line(folder.path.string()) + "\n");
    return {};
}

}  // namespace

void add_init_command(CLI::App& app, CommandOutcome& outcome) {
    CLI::App* const command = add_command(app, outcome, "init", "Make a site in an empty folder");
    auto folder = std::make_shared<std::string>(".");
    auto config = std::make_shared<ServeConfig>();
    add_text(command, "FOLDER", *folder, "the folder of the site; the current one if not given");
    command->add_option("--site", config->site, "the name of the site (mill)")->type_name("NAME");
    add_text(command, "--store", config->store,
             "connection string of the PostgreSQL database to keep it in (postgresql://HOST/DATABASE); a file if not given")
        ->type_name("CONNECTION");
    command->add_option("--host", config->hosts,
                        "a name or address that clients use, for the certificate; may be repeated")
        ->type_name("HOST");
    on_run(command, outcome,
           [folder, config, &outcome] { return make_new_site({*folder}, *config, outcome); });
}

}  // namespace weave::loomlink
