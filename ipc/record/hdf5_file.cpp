// SWMR ("single writer, multiple readers") makes a killed writer harmless: after H5Fstart_swmr_write the
// library orders its writes so that the file is consistent at any instant, and flushed data is safe. A kill
// leaves a mark in the superblock, and possibly a superblock with an older end of file; open_abandoned()
// fixes both like h5clear.
#include "ipc/record/hdf5_file.hpp"

#include <hdf5.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>

#include "ipc/base/error.hpp"

namespace tact {
namespace {

static_assert(sizeof(hid_t) == sizeof(Hdf5Id));

herr_t innermost(unsigned depth, const H5E_error2_t* error, void* text) {
    if (depth == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
    return 0;
}

[[noreturn]] void fail(const std::string& what) { throw RecordError(what + ": " + hdf5::last_error()); }

Hdf5Id checked(Hdf5Id id, const char* what) {
    if (id < 0) fail(what);
    return id;
}
void check(herr_t result, const char* what) {
    if (result < 0) fail(what);
}

hid_t type_of(Number n) {
    switch (n) {
        case Number::f64:
            return H5T_NATIVE_DOUBLE;
        case Number::f32:
            return H5T_NATIVE_FLOAT;
        case Number::i64:
            return H5T_NATIVE_INT64;
        case Number::u64:
            return H5T_NATIVE_UINT64;
        case Number::u32:
            return H5T_NATIVE_UINT32;
        case Number::u16:
            return H5T_NATIVE_UINT16;
        case Number::u8:
            break;
    }
    return H5T_NATIVE_UINT8;
}
std::size_t size_of(Number n) {
    constexpr std::array<std::size_t, 7> kSize{8, 4, 8, 8, 4, 2, 1};
    return kSize[static_cast<std::size_t>(n)];
}

// Copies the values of a column into one array: gathering by HDF5 itself takes 20 times as long.
void gather(const Column& c, std::size_t row_bytes, std::size_t count, const void* rows,
            std::vector<char>& to) {
    const std::size_t bytes = size_of(c.number) * c.width;
    to.resize(count * bytes);
    const char* from = static_cast<const char*>(rows) + c.offset;
    for (std::size_t i = 0; i < count; ++i) std::memcpy(to.data() + i * bytes, from + i * row_bytes, bytes);
}

void scatter(const Column& c, std::size_t row_bytes, std::size_t count, const std::vector<char>& from,
             void* rows) {
    const std::size_t bytes = size_of(c.number) * c.width;
    char* to = static_cast<char*>(rows) + c.offset;
    for (std::size_t i = 0; i < count; ++i) std::memcpy(to + i * row_bytes, from.data() + i * bytes, bytes);
}

Hdf5Handle memory_space(const Column& c, std::size_t count) {
    const hsize_t numbers = count * c.width;
    return Hdf5Handle(checked(H5Screate_simple(1, &numbers, nullptr), "describing rows"));
}

// File space of a selection of rows; a column of width 1 has one dimension.
Hdf5Handle file_space(const Hdf5Handle& set, const Column& c, std::uint64_t first, std::size_t count) {
    Hdf5Handle space(checked(H5Dget_space(set.get()), "inspecting a column"));
    const std::array<hsize_t, 2> start{first, 0}, own{count, c.width};
    check(H5Sselect_hyperslab(space.get(), H5S_SELECT_SET, start.data(), nullptr, own.data(), nullptr),
          "selecting rows");
    return space;
}

std::uint64_t length_of(const Hdf5Handle& set, const Column& c, const char* group) {
    const Hdf5Handle space(checked(H5Dget_space(set.get()), "inspecting a column"));
    std::array<hsize_t, 2> dims{0, 1};
    const int rank = H5Sget_simple_extent_ndims(space.get());
    if (rank != (c.width > 1 ? 2 : 1) ||
        H5Sget_simple_extent_dims(space.get(), dims.data(), nullptr) != rank || dims[1] != c.width)
        throw RecordError(std::string(group) + "/" + c.name +
                          " does not have the shape of a recording's column");
    return dims[0];
}

void write_attribute(Hdf5Id file, const char* object, const char* name, hid_t type, std::size_t count,
                     const void* value) {
    const hsize_t n = count;
    const Hdf5Handle space(checked(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &n, nullptr),
                                   "describing an attribute"));
    if (H5Aexists_by_name(file, object, name, H5P_DEFAULT) > 0)
        check(H5Adelete_by_name(file, object, name, H5P_DEFAULT), name);
    const Hdf5Handle attribute(checked(
        H5Acreate_by_name(file, object, name, type, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
        name));
    const bool written = H5Awrite(attribute.get(), type, value) >= 0;
    if (!written) fail(name);
}

Hdf5Handle text_type(std::size_t bytes) {
    Hdf5Handle type(checked(H5Tcopy(H5T_C_S1), "creating a text type"));
    check(H5Tset_size(type.get(), std::max<std::size_t>(bytes, 1)), "creating a text type");
    check(H5Tset_cset(type.get(), H5T_CSET_UTF8), "creating a text type");
    return type;
}

Hdf5Handle newest_format() {
    Hdf5Handle access(checked(H5Pcreate(H5P_FILE_ACCESS), "describing the file's access"));
    check(H5Pset_libver_bounds(access.get(), H5F_LIBVER_LATEST, H5F_LIBVER_LATEST), "choosing the format");
    return access;
}

}  // namespace

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
    if (this != &other) {
        reset();
        id_ = other.id_;
        other.id_ = -1;
    }
    return *this;
}

void Hdf5Handle::reset() noexcept {
    if (id_ < 0) return;
    switch (H5Iget_type(id_)) {
        case H5I_FILE:
            H5Fclose(id_);
            break;
        case H5I_GROUP:
            H5Gclose(id_);
            break;
        case H5I_DATASET:
            H5Dclose(id_);
            break;
        case H5I_DATASPACE:
            H5Sclose(id_);
            break;
        case H5I_DATATYPE:
            H5Tclose(id_);
            break;
        case H5I_ATTR:
            H5Aclose(id_);
            break;
        case H5I_GENPROP_LST:
            H5Pclose(id_);
            break;
        default:
            break;
    }
    id_ = -1;
}

Hdf5Table Hdf5Table::create(Hdf5Id file, const char* group, std::span<const Column> columns,
                            std::size_t row_bytes) {
    Hdf5Table table;
    table.row_bytes_ = row_bytes;
    hdf5::make_group(file, group);
    for (const Column& c : columns) {
        const std::array<hsize_t, 2> none{0, c.width}, unbounded{H5S_UNLIMITED, c.width},
            chunk{kChunkRows, c.width};
        const int rank = c.width > 1 ? 2 : 1;
        const Hdf5Handle space(
            checked(H5Screate_simple(rank, none.data(), unbounded.data()), "describing a column"));
        const Hdf5Handle layout(checked(H5Pcreate(H5P_DATASET_CREATE), "describing a column"));
        check(H5Pset_chunk(layout.get(), rank, chunk.data()), "describing a column");
        const std::string name = std::string(group) + "/" + c.name;
        Hdf5Handle set(checked(H5Dcreate2(file, name.c_str(), type_of(c.number), space.get(), H5P_DEFAULT,
                                          layout.get(), H5P_DEFAULT),
                               name.c_str()));
        if (*c.what != 0) hdf5::put_text(file, name.c_str(), "what", c.what);
        table.sets_.push_back({std::move(set), c});
    }
    return table;
}

bool Hdf5Table::exists(Hdf5Id file, const char* group) { return H5Lexists(file, group, H5P_DEFAULT) > 0; }

Hdf5Table Hdf5Table::open(Hdf5Id file, const char* group, std::span<const Column> columns,
                          std::size_t row_bytes) {
    Hdf5Table table;
    table.row_bytes_ = row_bytes;
    table.rows_ = ~std::uint64_t{0};
    for (const Column& c : columns) {
        std::string name = std::string(group) + "/" + c.name;
        if (*c.former != 0 && H5Lexists(file, name.c_str(), H5P_DEFAULT) <= 0)
            name = std::string(group) + "/" + c.former;
        Hdf5Handle set(checked(H5Dopen2(file, name.c_str(), H5P_DEFAULT), name.c_str()));
        const std::uint64_t length = length_of(set, c, group);
        table.rows_ = std::min(table.rows_, length);
        table.rows_most_ = std::max(table.rows_most_, length);
        table.sets_.push_back({std::move(set), c});
    }
    return table;
}

// Writes column by column: on a full disk the later ones are shorter, and the repair cuts to the shortest.
void Hdf5Table::append(const void* rows, std::size_t count) {
    if (count == 0) return;
    for (const Set& s : sets_) {
        const std::array<hsize_t, 2> size{rows_ + count, s.column.width};
        check(H5Dset_extent(s.set.get(), size.data()), "growing a column");
        put(s, rows_, count, rows);
    }
    rows_ += count;
    rows_most_ = rows_;
}

void Hdf5Table::write(std::uint64_t first, std::size_t count, const void* rows) const {
    for (const Set& s : sets_) put(s, first, count, rows);
}

void Hdf5Table::put(const Set& s, std::uint64_t first, std::size_t count, const void* rows) const {
    const Hdf5Handle to = file_space(s.set, s.column, first, count);
    const Hdf5Handle from = memory_space(s.column, count);
    gather(s.column, row_bytes_, count, rows, numbers_);
    check(H5Dwrite(s.set.get(), type_of(s.column.number), from.get(), to.get(), H5P_DEFAULT, numbers_.data()),
          s.column.name);
}

void Hdf5Table::read(std::uint64_t first, std::size_t count, void* rows) const {
    if (count == 0) return;
    for (const Set& s : sets_) {
        const Hdf5Handle from = file_space(s.set, s.column, first, count);
        const Hdf5Handle to = memory_space(s.column, count);
        numbers_.resize(count * size_of(s.column.number) * s.column.width);
        check(H5Dread(s.set.get(), type_of(s.column.number), to.get(), from.get(), H5P_DEFAULT,
                      numbers_.data()),
              s.column.name);
        scatter(s.column, row_bytes_, count, numbers_, rows);
    }
}

void Hdf5Table::flush() {
    for (const Set& s : sets_) check(H5Dflush(s.set.get()), s.column.name);
}

void Hdf5Table::cut(std::uint64_t rows) {
    for (const Set& s : sets_) {
        const std::array<hsize_t, 2> size{rows, s.column.width};
        check(H5Dset_extent(s.set.get(), size.data()), "cutting a column");
    }
    rows_ = rows_most_ = rows;
}

void Hdf5Table::release() noexcept {
    for (Set& s : sets_) s.set.release();
}

namespace hdf5 {

void quiet() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

std::string last_error() {
    std::string text;
    H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, &innermost, &text);
    return text.empty() ? "no reason given" : text;
}

Hdf5Handle create_file(const std::filesystem::path& path) {
    const Hdf5Handle access = newest_format();
    Hdf5Handle file(H5Fcreate(path.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access.get()));
    if (!file.valid()) {
        const std::string why = std::filesystem::exists(path) ? "the file exists already" : last_error();
        throw StartupError("creating the recording '" + path.string() + "'", why,
                           "choose a new file in a writable folder");
    }
    return file;
}

void start_shared_writing(Hdf5Id file) { check(H5Fstart_swmr_write(file), "starting to record"); }

void flush(Hdf5Id file) { check(H5Fflush(file, H5F_SCOPE_LOCAL), "writing to the file"); }

Hdf5Handle open_file(const std::filesystem::path& path, bool write) {
    const Hdf5Handle access = newest_format();
    Hdf5Handle file(H5Fopen(path.c_str(), write ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access.get()));
    if (!file.valid())
        throw StartupError("opening '" + path.string() + "'", last_error(),
                           "choose a file recorded by tact record");
    return file;
}

Hdf5Handle open_abandoned(const std::filesystem::path& path) {
    const Hdf5Handle access = newest_format();
    // Same flags as h5clear: clears the writer's mark, and accepts a wrong end of file.
    hbool_t yes = 1;
    check(H5Pset(access.get(), "clear_status_flags", &yes), "preparing the repair");
    check(H5Pset(access.get(), "skip_eof_check", &yes), "preparing the repair");
    Hdf5Handle file(H5Fopen(path.c_str(), H5F_ACC_RDWR, access.get()));
    if (!file.valid())
        throw StartupError("repairing '" + path.string() + "'", last_error(),
                           "restore the file from a copy; it was not changed");
    check(H5Fincrement_filesize(file.get(), 0), "finding the end of the file");
    return file;
}

// The superblock of format 2 or 3 is at offset 0 here: signature, version, two sizes, flags.
bool marked_open(const std::filesystem::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::array<char, 12> head{};
    constexpr std::array<char, 8> kSignature{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
    if (!in.read(head.data(), head.size()) || !std::equal(kSignature.begin(), kSignature.end(), head.begin()))
        throw RecordError("'" + path.string() + "' is not an HDF5 file");
    return head[8] >= 2 && head[11] != 0;
}

void make_group(Hdf5Id file, const char* name) {
    const Hdf5Handle group(
        checked(H5Gcreate2(file, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), "creating a group"));
}

void put_text(Hdf5Id file, const char* object, const char* name, const std::string& text) {
    const Hdf5Handle type = text_type(text.size());
    write_attribute(file, object, name, type.get(), 1, text.c_str());
}
void put_number(Hdf5Id file, const char* object, const char* name, std::uint64_t number) {
    write_attribute(file, object, name, H5T_NATIVE_UINT64, 1, &number);
}
void put_signed(Hdf5Id file, const char* object, const char* name, std::int64_t number) {
    write_attribute(file, object, name, H5T_NATIVE_INT64, 1, &number);
}
void put_reals(Hdf5Id file, const char* object, const char* name, std::span<const double> numbers) {
    write_attribute(file, object, name, H5T_NATIVE_DOUBLE, numbers.size(), numbers.data());
}

bool has(Hdf5Id file, const char* object, const char* name) {
    return H5Aexists_by_name(file, object, name, H5P_DEFAULT) > 0;
}

std::string text(Hdf5Id file, const char* object, const char* name, std::size_t bytes_max) {
    const Hdf5Handle attribute(checked(H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT), name));
    const Hdf5Handle type(checked(H5Aget_type(attribute.get()), name));
    const std::size_t size = H5Tget_size(type.get());
    const Hdf5Handle space(checked(H5Aget_space(attribute.get()), name));
    if (H5Tget_class(type.get()) != H5T_STRING || H5Tis_variable_str(type.get()) > 0 || size > bytes_max ||
        H5Sget_simple_extent_npoints(space.get()) != 1)
        throw RecordError(std::string("the attribute ") + name + " is not a text of a recording");
    std::string value(size, '\0');
    check(H5Aread(attribute.get(), type.get(), value.data()), name);
    value.resize(strnlen(value.data(), value.size()));
    return value;
}

std::uint64_t number(Hdf5Id file, const char* object, const char* name) {
    const Hdf5Handle attribute(checked(H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT), name));
    const Hdf5Handle space(checked(H5Aget_space(attribute.get()), name));
    if (H5Sget_simple_extent_npoints(space.get()) != 1)
        throw RecordError(std::string("the attribute ") + name + " is not one number");
    std::uint64_t value = 0;
    check(H5Aread(attribute.get(), H5T_NATIVE_UINT64, &value), name);
    return value;
}

void put_bytes(Hdf5Id file, const char* name, std::span<const char> bytes) {
    const hsize_t size = bytes.size();
    const Hdf5Handle space(checked(H5Screate_simple(1, &size, nullptr), name));
    const Hdf5Handle set(checked(
        H5Dcreate2(file, name, H5T_NATIVE_UINT8, space.get(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), name));
    if (size > 0)
        check(H5Dwrite(set.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, bytes.data()), name);
}

std::string bytes(Hdf5Id file, const char* name, std::size_t bytes_max) {
    const Hdf5Handle set(checked(H5Dopen2(file, name, H5P_DEFAULT), name));
    const Hdf5Handle space(checked(H5Dget_space(set.get()), name));
    const hssize_t size = H5Sget_simple_extent_npoints(space.get());
    if (size < 0 || static_cast<std::uint64_t>(size) > bytes_max)
        throw RecordError(std::string(name) + " exceeds the size limit of a recording");
    std::string value(static_cast<std::size_t>(size), '\0');
    if (size > 0)
        check(H5Dread(set.get(), H5T_NATIVE_UINT8, H5S_ALL, H5S_ALL, H5P_DEFAULT, value.data()), name);
    return value;
}

}  // namespace hdf5
}  // namespace tact
