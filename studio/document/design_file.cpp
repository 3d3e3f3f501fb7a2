#include <studio/document/design_file.hpp>

#include <weave/design/document.hpp>

#include <filesystem>

namespace weave::studio {

void DesignFile::note(const std::string& path, const Design& design) {
    m_path = path;
    m_design = design;
}

bool DesignFile::was_changed(const std::string& path) const {
    std::error_code ignored;
    if (!m_design || path != m_path || !std::filesystem::exists(path, ignored)) return false;
    // Read and compared: times and sizes would tell of copies and backups that changed nothing, and miss what was quick.
    const auto there = load_design(path);
    return !there || !(*there == *m_design);
}

Status DesignFile::save(const std::string& path, const Design& design) {
    WEAVE_CHECK_OK(save_design(design, path));
    note(path, design);
    return {};
}

}  // namespace weave::studio
