#include <loomlink/export/package.hpp>

#include <weave/design/document.hpp>
#include <weave/io/export_parts.hpp>
#include <weave/io/wif.hpp>

#include <loomlink/export/manifest.hpp>
#include <loomlink/export/read_back.hpp>
#include <optional>

namespace weave::loomlink {

namespace {

/// What every step of a package needs to know.
struct Task {
    const Design& design;
    const Block& block;
    const LoomProfile& profile;
    const FeederMap& feeders;
    const ReleaseNames& names;
    std::string stem;
    CardImage card;
    std::vector<Pick> picks;
};

/// Collects files with their entries.
class Packer {
  public:
    void add(PackageFile file, const Json& more) {
        Json entry = file_entry(file);
        entry.update(more);
        m_entries.push_back(std::move(entry));
        m_package.files.push_back(std::move(file));
    }
    void note(std::string text) { m_package.notes.push_back(std::move(text)); }

    ReleasePackage finish(Json manifest) && {
        manifest["files"] = std::move(m_entries);
        m_package.manifest = std::move(manifest);
        return std::move(m_package);
    }

  private:
    ReleasePackage m_package;
    Json m_entries = Json::array();
};

Status check_map(const Design& design, const LoomProfile& profile, const FeederMap& feeders) {
    for (const auto& [feeder, on_loom] : feeders) {
        if (feeder >= design.weft.feeders.size())
            return invalid("the feeder map names feeder " + std::to_string(feeder + 1) +
                           ", which the design does not have");
        if (on_loom >= profile.feeders)
            return invalid("the feeder map names feeder " + std::to_string(on_loom + 1) +
                           ", which the loom does not have");
    }
    return {};
}

Status add_controller_file(const Task& task, const HookPlan& plan, Packer& packer) {
    WEAVE_TRY(WrittenFile made, write_controller_file(plan, task.profile, task.names.in_file));
    WEAVE_CHECK_OK(check_controller_file(made.bytes, made.names, plan, task.card, task.profile));
    if (made.name_cut)
        packer.note("the name '" + task.names.in_file.name + "' is cut to '" + made.names.name +
                    "' in the file");
    const std::string& format = name_of(task.profile.output);
    const bool named = task.profile.output != OutputFormat::raw;
    packer.add({task.stem + "." + format, format, std::move(made.bytes)},
               {{"for", "the controller"},
                {"reading", controller_reading(plan, task.profile, task.card.ends())},
                {"name_in_file", named ? Json(made.names.name) : Json()},
                {"name_cut", made.name_cut},
                {"unknown_fields", made.unknown_fields},
                {"never_observed", made.assumed}});
    return {};
}

Status add_picture(const Task& task, BitmapFormat format, const BitmapReading& reading, const char* use,
                   Packer& packer) {
    WEAVE_TRY(std::string bytes, write_proven_bitmap(task.card, format, reading));
    packer.add({task.stem + "-card." + extension_of(format), name_of(format), std::move(bytes)},
               {{"for", use}, {"reading", reading_entry(reading, format)}});
    return {};
}

Status add_pick_table(const Task& task, Packer& packer) {
    std::string csv = pick_table_csv(task.design, task.picks, &task.feeders);
    WEAVE_CHECK_OK(check_pick_table(csv, task.picks, task.feeders));
    packer.add({task.stem + "-picks.csv", "pick-table-csv", std::move(csv)},
               {{"for", "people, and the mill's CAD"}});
    return {};
}

Status add_wif(const Task& task, Packer& packer) {
    WEAVE_TRY(std::string text, write_wif(task.design, task.block, task.card));
    WEAVE_CHECK_OK(check_wif(text, task.card, task.picks));
    packer.add({task.stem + ".wif", "wif", std::move(text)}, {{"for", "other programs"}});
    return {};
}

std::optional<BitmapFormat> bitmap_of(ExtraFile extra) {
    switch (extra) {
        case ExtraFile::png:
            return BitmapFormat::png;
        case ExtraFile::tiff:
            return BitmapFormat::tiff;
        case ExtraFile::bmp:
            return BitmapFormat::bmp;
        case ExtraFile::wif:
            break;
    }
    return {};
}

/// Files beside the loom's own. A picture that is there already is not made twice.
Status add_extras(const Task& task, const std::set<ExtraFile>& extras, Packer& packer) {
    const bool for_loom = takes_picture(task.profile.output);
    if (!for_loom) WEAVE_CHECK_OK(add_picture(task, BitmapFormat::png, {}, "the eye", packer));
    const BitmapFormat there = picture_format(task.profile);
    for (const ExtraFile extra : extras) {
        const std::optional<BitmapFormat> format = bitmap_of(extra);
        if (!format) {
            WEAVE_CHECK_OK(add_wif(task, packer));
        } else if (*format != there) {
            WEAVE_CHECK_OK(add_picture(task, *format, {}, "other programs", packer));
        }
    }
    return {};
}

Json conversion_entry(const LoomProfile& profile, const std::string& stem) {
    if (profile.converts_to.empty()) return nullptr;
    return {{"to", profile.converts_to},
            {"words",
             "No bytes of " + profile.converts_to +
                 " are public, so this package has none. The mill's CAD must convert the picture " + stem +
                 "-card and the pick table " + stem +
                 "-picks.csv, which tells the feeder and the take-up of "
                 "each pick, and add selvedge and function hooks. What comes out of it is not proved by this "
                 "package."}};
}

Json body(const Task& task, const HookPlan& plan) {
    const LoomProfile& profile = task.profile;
    return {
        {"format", "weave-release-package"},
        {"version", 1},
        {"certified", false},
        {"label", layout_label},
        {"title", task.design.title},
        {"design_sha256", design_sha256(task.design)},
        {"scene_sha256", scene_sha256(task.design)},
        {"card_sha256", task.card.sha256()},
        {"picks", task.card.picks()},
        {"ends", task.card.ends()},
        {"repeats", {{"along", 1}, {"across", profile.hook_rule == HookRule::repeats ? profile.repeats : 1}}},
        {"loom", loom_entry(profile)},
        {"output", name_of(profile.output)},
        {"conversion", conversion_entry(profile, task.stem)},
        {"hooks", hooks_entry(plan, profile, task.card.ends())},
        {"feeders", feeders_entry(task.design, profile, task.feeders)},
        {"take_up", take_up_entry(task.picks, profile)}};
}

}  // namespace

Result<ReleasePackage> make_release_package(const Design& design, const Evaluation& cloth,
                                            const LoomProfile& profile, const FeederMap& feeders,
                                            const ReleaseNames& names, const std::set<ExtraFile>& extras) {
    WEAVE_CHECK_OK(check_map(design, profile, feeders));
    const Task task{design,
                    *cloth.block,
                    profile,
                    feeders,
                    names,
                    plain_name(names.stem),
                    cloth.block->card_image(),
                    pick_table(design, *cloth.block)};
    WEAVE_TRY(const HookPlan plan, plan_hooks(design, task.card, task.picks, profile, feeders));
    Packer packer;
    if (takes_picture(profile.output)) {
        const char* const use = profile.converts_to.empty() ? "the loom" : "the mill's CAD";
        WEAVE_CHECK_OK(add_picture(task, picture_format(profile), picture_reading(profile), use, packer));
    } else {
        WEAVE_CHECK_OK(add_controller_file(task, plan, packer));
    }
    WEAVE_CHECK_OK(add_pick_table(task, packer));
    WEAVE_CHECK_OK(add_extras(task, extras, packer));
    Json manifest = body(task, plan);
    if (!manifest["conversion"].is_null()) packer.note(manifest["conversion"]["words"].get<std::string>());
    return std::move(packer).finish(std::move(manifest));
}

ReadBack read_back(const Design& design, const Evaluation& cloth, const LoomProfile& profile,
                   const FeederMap& feeders, const InFileNames& names) {
    const CardImage card = cloth.block->card_image();
    const Result<HookPlan> plan =
        plan_hooks(design, card, pick_table(design, *cloth.block), profile, feeders);
    if (!plan) return {ReadBack::Outcome::no_file, plan.error().text()};
    const Result<WrittenFile> made = write_controller_file(*plan, profile, names);
    if (!made) return {ReadBack::Outcome::no_file, made.error().text()};
    const Status proved = check_controller_file(made->bytes, made->names, *plan, card, profile);
    if (proved) return {ReadBack::Outcome::equal, ""};
    return {ReadBack::Outcome::differs, proved.error().text()};
}

}  // namespace weave::loomlink
