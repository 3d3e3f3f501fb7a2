// Headerless raw: the records alone, in everything as the profile says.

#include <loomlink/export/file_parts.hpp>
#include <loomlink/export/records.hpp>

namespace weave::loomlink {

Result<WrittenFile> write_raw(const HookPlan& plan, const LoomProfile& profile) {
    WEAVE_TRY(const RecordLayout layout, record_layout(profile));
    WrittenFile file;
    file.bytes = records(plan, profile, layout);
    file.assumed = {"the file has no header: order of hooks, polarity and feeders are the profile's alone"};
    note_settings(file, plan, profile);
    return file;
}

Result<WrittenFile> write_controller_file(const HookPlan& plan, const LoomProfile& profile,
                                          const InFileNames& names) {
    switch (profile.output) {
        case OutputFormat::jc5:
            return write_jc5(plan, profile, names);
        case OutputFormat::ep:
            return write_ep(plan, profile, names);
        case OutputFormat::raw:
            return write_raw(plan, profile);
        case OutputFormat::tiff:
        case OutputFormat::png:
        case OutputFormat::bmp:
            break;
    }
    return invalid("this loom takes a picture, not a controller's file");
}

}  // namespace weave::loomlink
