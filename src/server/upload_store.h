// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <string>

#include "foundation/result.h"

namespace embody::server {

/// Largest size of one uploaded file, bytes.
inline constexpr std::uint64_t largest_upload = std::uint64_t{256} << 20;
/// Largest number of uploads that are being received or wait for their import; others are refused meanwhile.
inline constexpr std::size_t most_uploads = 8;

class UploadStore;

/// A file that a client sends, on disk under its own name; removed with the object. Used by one thread at a time.
class Upload {
public:
    ~Upload();
    Upload(const Upload&) = delete;
    Upload& operator=(const Upload&) = delete;

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    /// Appends bytes; fails where the disk is full.
    Result<void> write(std::span<const char> bytes);
    /// Closes the file after its last byte: it can be read.
    Result<void> finish();

private:
    friend class UploadStore;
    Upload(std::shared_ptr<UploadStore> store, std::filesystem::path file, int descriptor)
        : store_(std::move(store)), file_(std::move(file)), descriptor_(descriptor) {}
    std::shared_ptr<UploadStore> store_;
    std::filesystem::path file_;  ///< the only file of its folder
    int descriptor_;
};

/// Holds uploads until they are imported, in a folder of this process, which it locks, inside one folder for all
/// processes. The next start removes what a killed process left there. Thread-safe.
class UploadStore : public std::enable_shared_from_this<UploadStore> {
public:
    static Result<std::shared_ptr<UploadStore>> open(const std::filesystem::path& folder_of_all);
    ~UploadStore();

    /// `name`: the file's name, because importers are chosen by its extension. Fails where there are too many uploads
    /// already.
    Result<std::shared_ptr<Upload>> begin(const std::string& name);
    /// At the end of the program, even where uploads are still in use.
    void remove_all();

private:
    friend class Upload;
    UploadStore(std::filesystem::path folder, int lock) : folder_(std::move(folder)), lock_(lock) {}
    void forget(const std::filesystem::path& upload_folder);

    std::filesystem::path folder_;
    int lock_;
    std::mutex mutex_;
    std::set<std::filesystem::path> uploads_;  ///< folders of the uploads
    std::uint64_t next_ = 1;
};

}  // namespace embody::server
