// SPDX-License-Identifier: MIT
#pragma once

#include <assimp/IOSystem.hpp>

#include "interchange/file_source.h"

namespace embody::interchange {

/// Lets assimp see one FileSource and nothing else; nothing can be written.
class SourceFiles final : public Assimp::IOSystem {
public:
    explicit SourceFiles(const FileSource& source) : source_(&source) {}
    bool Exists(const char* path) const override { return !source_->find(path).empty(); }
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* path, const char* mode) override;
    void Close(Assimp::IOStream* stream) override;

private:
    const FileSource* source_;
};

}  // namespace embody::interchange
