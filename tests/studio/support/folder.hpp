#pragma once

#include <QTemporaryDir>

#include <filesystem>

namespace weave::studio::test {

/// A folder that goes with its test.
class Folder {
  public:
    [[nodiscard]] std::filesystem::path path() const { return m_folder.path().toStdString(); }

  private:
    QTemporaryDir m_folder;
};

}  // namespace weave::studio::test
