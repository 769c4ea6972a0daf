// Parses words and numbers of text headers (NRRD, MetaImage) and of label lists.
#pragma once

#include <charconv>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "ipc/base/error.hpp"

namespace tact {

class HeaderText {
public:
    HeaderText(std::string_view bytes, std::string attempt,
               const char* fix = "export the scan again as one file with three axes")
        : bytes_(bytes), attempt_(std::move(attempt)), fix_(fix) {}

    // The next line without its end; false at the end of the file. Rejects long lines: headers have short ones.
    bool line(std::string_view& out) {
        if (at_ >= bytes_.size()) return false;
        const std::size_t end = bytes_.find('\n', at_);
        if (end - at_ > kLineMax && bytes_.size() - at_ > kLineMax) fail("a line is too long");
        out = bytes_.substr(at_, end == std::string_view::npos ? end : end - at_);
        at_ = end == std::string_view::npos ? bytes_.size() : end + 1;
        if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
        if (++lines_ > kLinesMax) fail("the text has more than " + std::to_string(kLinesMax) + " lines");
        return true;
    }
    [[nodiscard]] std::size_t position() const { return at_; }

    [[noreturn]] void fail(const std::string& why) const { throw StartupError(attempt_, why, fix_); }
    static std::string_view trimmed(std::string_view s) {
        while (!s.empty() && (s.front() == ' ' || s.front() == '\t')) s.remove_prefix(1);
        while (!s.empty() && (s.back() == ' ' || s.back() == '\t')) s.remove_suffix(1);
        return s;
    }
    static std::string lower(std::string_view s) {
        std::string out(s);
        for (char& c : out)
            if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
        return out;
    }
    static std::vector<std::string_view> words(std::string_view s, std::string_view separators = " \t") {
        std::vector<std::string_view> out;
        while (!s.empty()) {
            const std::size_t begin = s.find_first_not_of(separators);
            if (begin == std::string_view::npos) break;
            const std::size_t end = s.find_first_of(separators, begin);
            out.push_back(s.substr(begin, end == std::string_view::npos ? end : end - begin));
            if (end == std::string_view::npos) break;
            s.remove_prefix(end);
        }
        return out;
    }
    [[nodiscard]] double number(std::string_view word, const char* what) const {
        double value = 0.0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size() || !std::isfinite(value))
            fail(std::string(what) + " is \"" + std::string(word.substr(0, 40)) + "\", not a number");
        return value;
    }
    [[nodiscard]] std::uint64_t whole(std::string_view word, const char* what) const {
        std::uint64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc{} || end != word.data() + word.size())
            fail(std::string(what) + " is \"" + std::string(word.substr(0, 40)) + "\", not a whole number");
        return value;
    }

private:
    static constexpr std::size_t kLineMax = 65536, kLinesMax = 20000;
    std::string_view bytes_;
    std::string attempt_;
    const char* fix_;
    std::size_t at_ = 0, lines_ = 0;
};

}  // namespace tact
