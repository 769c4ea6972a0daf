// The HDF5 functions of a recording: files, groups, growing columns, attributes. Only the .cpp includes
// hdf5.h.
//
// Column   a dataset of rows x width numbers, chunked, that grows without bound. A table is a group of
//          columns that stores one C++ struct per row; each column holds the offset of its numbers in the
//          struct.
// Thread   one at a time; HDF5 is used without its thread support
// Errors   StartupError (opening, creating) and RecordError (writing, reading) with HDF5's innermost
//          message
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace tact {

struct RecordError : std::runtime_error {
    using std::runtime_error::runtime_error;
};

enum class Number : std::uint8_t { f64, f32, i64, u64, u32, u16, u8 };

struct Column {
    const char* name;
    Number number;
    std::size_t offset;  // in the row's struct
    std::uint32_t width = 1;
    const char* what = "";    // unit and meaning, stored in the file
    const char* former = "";  // name in recordings made before a renaming; empty: never renamed
};

using Hdf5Id = std::int64_t;

// Owns an HDF5 handle and closes it.
class Hdf5Handle {
public:
    Hdf5Handle() = default;
    explicit Hdf5Handle(Hdf5Id id) noexcept : id_(id) {}
    ~Hdf5Handle() { reset(); }
    Hdf5Handle(Hdf5Handle&& other) noexcept : id_(other.id_) { other.id_ = -1; }
    Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
    [[nodiscard]] Hdf5Id get() const { return id_; }
    [[nodiscard]] bool valid() const { return id_ >= 0; }
    void reset() noexcept;
    // Releases the handle unclosed, when closing would write to a full disk.
    void release() noexcept { id_ = -1; }

private:
    Hdf5Id id_ = -1;
};

class Hdf5Table {
public:
    static constexpr std::uint64_t kChunkRows = 1024;

    Hdf5Table() = default;
    // Creates group and columns; rows of row_bytes.
    static Hdf5Table create(Hdf5Id file, const char* group, std::span<const Column> columns,
                            std::size_t row_bytes);
    // Throws RecordError if the group lacks a column or a column has another shape.
    static Hdf5Table open(Hdf5Id file, const char* group, std::span<const Column> columns,
                          std::size_t row_bytes);
    [[nodiscard]] static bool exists(Hdf5Id file, const char* group);

    void append(const void* rows, std::size_t count);
    // Overwrites existing rows.
    void write(std::uint64_t first, std::size_t count, const void* rows) const;
    // Reads existing rows from `first` on; columns missing in the file are skipped.
    void read(std::uint64_t first, std::size_t count, void* rows) const;
    void flush();
    // The number of rows in all columns. Column lengths differ after a kill of the writer.
    [[nodiscard]] std::uint64_t rows() const { return rows_; }
    [[nodiscard]] std::uint64_t rows_most() const { return rows_most_; }
    // Cuts all columns to one length.
    void cut(std::uint64_t rows);
    void release() noexcept;

private:
    struct Set {
        Hdf5Handle set;
        Column column;
    };
    void put(const Set& s, std::uint64_t first, std::size_t count, const void* rows) const;

    std::vector<Set> sets_;
    std::size_t row_bytes_ = 0;
    mutable std::vector<char> numbers_;  // buffer for one column
    std::uint64_t rows_ = 0, rows_most_ = 0;
};

namespace hdf5 {

void quiet();  // reports errors as exceptions only, never on standard error
[[nodiscard]] std::string last_error();
[[nodiscard]] Hdf5Handle create_file(
    const std::filesystem::path& path);  // allows readers while the writer writes
void start_shared_writing(Hdf5Id file);  // no new objects after this call
void flush(Hdf5Id file);
[[nodiscard]] Hdf5Handle open_file(const std::filesystem::path& path, bool write);
// For a file whose writer died: clears its mark and sets the actual end of the file.
[[nodiscard]] Hdf5Handle open_abandoned(const std::filesystem::path& path);
// True if the writer's mark is set. Throws RecordError if this is not an HDF5 file.
[[nodiscard]] bool marked_open(const std::filesystem::path& path);
void make_group(Hdf5Id file, const char* name);

void put_text(Hdf5Id file, const char* object, const char* name, const std::string& text);
void put_number(Hdf5Id file, const char* object, const char* name, std::uint64_t number);
void put_signed(Hdf5Id file, const char* object, const char* name, std::int64_t number);
void put_reals(Hdf5Id file, const char* object, const char* name, std::span<const double> numbers);
[[nodiscard]] bool has(Hdf5Id file, const char* object, const char* name);
[[nodiscard]] std::string text(Hdf5Id file, const char* object, const char* name, std::size_t bytes_max);
[[nodiscard]] std::uint64_t number(Hdf5Id file, const char* object, const char* name);
// A dataset of bytes with a fixed length, and its content.
void put_bytes(Hdf5Id file, const char* name, std::span<const char> bytes);
[[nodiscard]] std::string bytes(Hdf5Id file, const char* name, std::size_t bytes_max);

}  // namespace hdf5
}  // namespace tact
