// Splits a text into lines and words, without copies. Numbers are parsed by std::from_chars, independent of the locale.
#pragma once

#include <charconv>
#include <cstdint>
#include <string_view>

namespace tact {

class TextScan {
public:
    explicit TextScan(std::string_view text) : text_(text) {}

    // Advances to the next line (without its end); false at the end of the text.
    bool next_line() {
        if (place_ >= text_.size()) return false;
        const std::size_t end = std::min(text_.find('\n', place_), text_.size());
        line_ = text_.substr(place_, end - place_);
        place_ = end + 1;
        ++number_;
        return true;
    }
    // The next word of the line; empty at the end of the line.
    std::string_view word() {
        std::size_t i = 0;
        while (i < line_.size() && blank(line_[i])) ++i;
        std::size_t end = i;
        while (end < line_.size() && !blank(line_[end])) ++end;
        const std::string_view found = line_.substr(i, end - i);
        line_.remove_prefix(end);
        return found;
    }
    // The next word, across lines; empty at the end of the text.
    std::string_view word_of_any_line() {
        for (;;) {
            const std::string_view found = word();
            if (!found.empty() || !next_line()) return found;
        }
    }
    [[nodiscard]] std::uint64_t line_number() const { return number_; }
    [[nodiscard]] std::size_t place() const { return place_; }
    [[nodiscard]] std::string_view line() const { return line_; }

    template <class T>
    static bool number(std::string_view word, T& value) {
        if (!word.empty() && word[0] == '+') word.remove_prefix(1);
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        return error == std::errc{} && end == word.data() + word.size();
    }

private:
    static bool blank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f'; }
    std::string_view text_, line_;
    std::size_t place_ = 0;
    std::uint64_t number_ = 0;
};

}  // namespace tact
