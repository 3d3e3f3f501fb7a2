#pragma once

#include <weave/core/result.hpp>
#include <weave/design/design.hpp>

#include <optional>
#include <string>

namespace weave::studio {

/// The file that a document was read from or saved to last, and what it held then, so that nothing is lost that somebody else
/// put there since.
class DesignFile {
  public:
    /// The file holds this.
    void note(const std::string& path, const Design& design);
    /// Whether this is the file, and it holds something else by now. Where it is gone, nothing can be lost.
    [[nodiscard]] bool was_changed(const std::string& path) const;
    /// Writes it, whole or not at all.
    Status save(const std::string& path, const Design& design);

  private:
    std::string m_path;
    std::optional<Design> m_design;
};

}  // namespace weave::studio
