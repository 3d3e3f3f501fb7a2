#include <loomlink/commands/bootstrap.hpp>

#include <weave/core/text.hpp>

#include <loomlink/commands/site_folder.hpp>
#include <loomlink/workflow/workflow.hpp>
#include <memory>
#include <string>

namespace weave::loomlink {

namespace {

Status bootstrap(const SiteFolder& folder, CommandOutcome& outcome) {
    if (!folder.holds_site())
        return bad_input("holds no site", folder.path.string());
    WEAVE_TRY(OpenSite site, open_site(folder, {}));
    WEAVE_TRY(const auto workflow, Workflow::open(std::move(site.store), std::move(site.keys)));
    WEAVE_TRY(const Json invitation, workflow->accounts().recovery_invitation());
    outcome.answer(invitation, "An administrator joins with this code, once, until " +
                                   invitation.value("expires", std::string()) + ": " +
                                   invitation.value("code", std::string()) +
                                   "\nIt stands in the log that it was made here. Serve the site: loomlink serve " +
                                   on_one_line(folder.path.string()) + "\n");
    return {};
}

}  // namespace

void add_user_bootstrap(CLI::App& user, CommandOutcome& outcome) {
    CLI::App* const command =
        add_command(user, outcome, "bootstrap",
                    "On the machine of the site, while it is not served: invite an administrator, where "
                    "none can sign in any more",
                    "loomlink user bootstrap /srv/mill");
    const auto folder = std::make_shared<std::string>();
    add_text(command, "FOLDER", *folder, "the folder of the site")->required();
    on_run(command, outcome, [folder, &outcome] { return bootstrap({*folder}, outcome); });
}

}  // namespace weave::loomlink
