// Reads and writes plain values in the bytes of a section, with every count checked before use.
//
// Layout    little endian, no padding between items; text is a 32-bit length and its bytes
// Errors    StartupError with the file, the section and the item. A count larger than the available bytes
//           is refused, so no reader allocates more than the length of the file
// Thread    any but the servo thread
#pragma once

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "ipc/base/error.hpp"

namespace tact {

static_assert(std::endian::native == std::endian::little, "baked scenes are little endian");

class BytesOut {
public:
    template <class T>
    void put(const T& value) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(&value, sizeof(T));
    }
    template <class T>
    void put_all(std::span<const T> values) {
        static_assert(std::is_trivially_copyable_v<T>);
        append(values.data(), values.size_bytes());
    }
    template <class T>
    void put_all(const std::vector<T>& values) {
        put_all(std::span<const T>(values));
    }
    void put_text(const std::string& text) {
        put(static_cast<std::uint32_t>(text.size()));
        append(text.data(), text.size());
    }
    [[nodiscard]] std::vector<std::byte> take() { return std::move(bytes_); }

private:
    void append(const void* data, std::size_t size) {
        if (size == 0) return;
        const std::size_t at = bytes_.size();
        bytes_.resize(at + size);
        std::memcpy(bytes_.data() + at, data, size);
    }
    std::vector<std::byte> bytes_;
};

class BytesIn {
public:
    // `where` is the file and section for messages: "ring.tact, section BODY 0".
    BytesIn(std::span<const std::byte> bytes, std::string where) : bytes_(bytes), where_(std::move(where)) {}

    template <class T>
    T get(const char* what) {
        static_assert(std::is_trivially_copyable_v<T>);
        need(1, sizeof(T), what);
        T value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(T));
        at_ += sizeof(T);
        return value;
    }
    template <class T>
    std::vector<T> get_all(std::uint64_t count, const char* what) {
        static_assert(std::is_trivially_copyable_v<T>);
        need(count, sizeof(T), what);
        std::vector<T> values(static_cast<std::size_t>(count));
        if (count > 0) std::memcpy(values.data(), bytes_.data() + at_, values.size() * sizeof(T));
        at_ += values.size() * sizeof(T);
        return values;
    }
    std::string get_text(std::uint32_t longest, const char* what) {
        const auto size = get<std::uint32_t>(what);
        if (size > longest) {
            fail(std::string(what) + " has " + std::to_string(size) + " bytes, more than " +
                 std::to_string(longest));
        }
        need(size, 1, what);
        std::string text(reinterpret_cast<const char*>(bytes_.data() + at_), size);
        at_ += size;
        for (const char c : text) {
            if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f)
                fail(std::string(what) + " contains a control character");
        }
        return text;
    }
    // Checks that every number is finite and at most `largest`.
    template <class T>
    void check_finite(const std::vector<T>& values, double largest, const char* what) const {
        for (std::size_t i = 0; i < values.size(); ++i) {
            if (!(std::abs(static_cast<double>(values[i])) <= largest)) {
                fail(std::string(what) + " " + std::to_string(i) + " is " + std::to_string(values[i]));
            }
        }
    }
    void finish() const {
        if (at_ != bytes_.size()) {
            fail(std::to_string(bytes_.size() - at_) + " bytes follow its content");
        }
    }
    [[noreturn]] void fail(const std::string& why) const {
        throw StartupError("read scene " + where_, why,
                           "bake the scene again with this version of tact-prep");
    }

private:
    void need(std::uint64_t count, std::size_t each, const char* what) const {
        const std::size_t left = bytes_.size() - at_;
        if (count > left / each) {
            fail(std::string(what) + " needs " + std::to_string(count) + " x " + std::to_string(each) +
                 " bytes, but only " + std::to_string(left) + " are left");
        }
    }
    std::span<const std::byte> bytes_;
    std::size_t at_ = 0;
    std::string where_;
};

}  // namespace tact
