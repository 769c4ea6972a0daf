// What a recording needs of HDF5: files, groups, columns that grow, attributes. hdf5.h is included here alone (.cpp).
//
// Column   a dataset of rows x width numbers, chunked, that grows without bound. A table is a group of columns that
//          take one C++ struct a row; each column knows where in it its numbers lie.
// Thread   one at a time; HDF5 is not told of threads.
// Fails by StartupError (opening, creating) and RecordError (writing, reading): what, and HDF5's own innermost word.
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
    const char* what = "";    // unit and meaning, as the file states it
    const char* former = "";  // name in recordings made before it was renamed; empty: it never was
};

using Hdf5Id = std::int64_t;

// Closes what it holds.
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
    // Forgets it unclosed, where closing would write to a disk that takes no more.
    void release() noexcept { id_ = -1; }

private:
    Hdf5Id id_ = -1;
};

class Hdf5Table {
public:
    static constexpr std::uint64_t kChunkRows = 1024;

    Hdf5Table() = default;
    // Makes group and columns; rows of row_bytes.
    static Hdf5Table create(Hdf5Id file, const char* group, std::span<const Column> columns,
                            std::size_t row_bytes);
    // Throws RecordError where the group lacks a column or it has another shape.
    static Hdf5Table open(Hdf5Id file, const char* group, std::span<const Column> columns,
                          std::size_t row_bytes);
    [[nodiscard]] static bool exists(Hdf5Id file, const char* group);

    void append(const void* rows, std::size_t count);
    // Over rows that there are.
    void write(std::uint64_t first, std::size_t count, const void* rows) const;
    // Rows from first on, which there must be; columns that the file lacks do not exist here.
    void read(std::uint64_t first, std::size_t count, void* rows) const;
    void flush();
    // The rows that all columns have. They differ where a writer was killed.
    [[nodiscard]] std::uint64_t rows() const { return rows_; }
    [[nodiscard]] std::uint64_t rows_most() const { return rows_most_; }
    // Columns to one length.
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
    mutable std::vector<char> numbers_;  // of one column, on their way
    std::uint64_t rows_ = 0, rows_most_ = 0;
};

namespace hdf5 {

void quiet();  // errors as exceptions alone, never on standard error
[[nodiscard]] std::string last_error();
[[nodiscard]] Hdf5Handle create_file(const std::filesystem::path& path);  // for a reader beside the writer
void start_shared_writing(Hdf5Id file);                                   // no new object from here on
void flush(Hdf5Id file);
[[nodiscard]] Hdf5Handle open_file(const std::filesystem::path& path, bool write);
// Of a file whose writer died: takes away its mark, and the end of the file where it really is.
[[nodiscard]] Hdf5Handle open_abandoned(const std::filesystem::path& path);
// The mark that a writer leaves while it has the file open. Throws RecordError where this is no HDF5 file.
[[nodiscard]] bool marked_open(const std::filesystem::path& path);
void make_group(Hdf5Id file, const char* name);

void put_text(Hdf5Id file, const char* object, const char* name, const std::string& text);
void put_number(Hdf5Id file, const char* object, const char* name, std::uint64_t number);
void put_signed(Hdf5Id file, const char* object, const char* name, std::int64_t number);
void put_reals(Hdf5Id file, const char* object, const char* name, std::span<const double> numbers);
[[nodiscard]] bool has(Hdf5Id file, const char* object, const char* name);
[[nodiscard]] std::string text(Hdf5Id file, const char* object, const char* name, std::size_t bytes_max);
[[nodiscard]] std::uint64_t number(Hdf5Id file, const char* object, const char* name);
// A dataset of bytes, of any fixed length; and its content.
void put_bytes(Hdf5Id file, const char* name, std::span<const char> bytes);
[[nodiscard]] std::string bytes(Hdf5Id file, const char* name, std::size_t bytes_max);

}  // namespace hdf5
}  // namespace tact
