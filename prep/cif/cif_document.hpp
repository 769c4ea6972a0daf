// A CIF document: read, change in place, write. Wraps gemmi; only cif_document.cpp includes its headers.
//
// Tables    select columns by tag, in any order; a tag that begins with "?" may be absent. A table is empty if a
//           required column is absent. It refers to its document: it becomes invalid when the document is destroyed
//           or a table or pair is added or erased.
// Errors    read() throws std::runtime_error or a class derived from it with line and cause; indices are not checked.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace tact {

class CifTable {
public:
    CifTable(CifTable&&) noexcept;
    CifTable& operator=(CifTable&&) noexcept;
    CifTable(const CifTable&) = delete;
    CifTable& operator=(const CifTable&) = delete;
    ~CifTable();
    [[nodiscard]] std::size_t rows() const;
    // True if the column exists.
    [[nodiscard]] bool has(std::size_t column) const;
    // Text as in the file, with quotes; the column must exist.
    [[nodiscard]] const std::string& raw(std::size_t row, std::size_t column) const;
    // Without quotes; "" where the column is absent or the value is "." (not applicable) or "?" (unknown).
    [[nodiscard]] std::string value(std::size_t row, std::size_t column) const;
    // True if the value is neither "." nor "?".
    [[nodiscard]] bool known(std::size_t row, std::size_t column) const;
    void set(std::size_t row, std::size_t column, std::string raw);

private:
    friend class CifDocument;
    struct Table;
    explicit CifTable(std::unique_ptr<Table> table);
    std::unique_ptr<Table> table_;
};

class CifDocument {
public:
    // Error texts contain `name`.
    static CifDocument read(std::string_view text, const std::string& name);
    // A document of one empty block.
    static CifDocument with_block(const std::string& name);
    CifDocument(CifDocument&&) noexcept;
    CifDocument& operator=(CifDocument&&) noexcept;
    CifDocument(const CifDocument&) = delete;
    CifDocument& operator=(const CifDocument&) = delete;
    ~CifDocument();

    [[nodiscard]] std::size_t blocks() const;
    [[nodiscard]] CifTable table(std::size_t block, const std::string& prefix,
                                 const std::vector<std::string>& tags);
    // Replaces the value of the tag, or adds the pair if the tag is absent. Quotes `value` as needed.
    void set_pair(std::size_t block, const std::string& tag, const std::string& value);
    // Removes all pairs and tables whose tags begin with one of the prefixes.
    void erase(std::size_t block, const std::vector<std::string>& prefixes);
    // Each row holds one raw value for each tag, row after row.
    void add_table(std::size_t block, const std::string& prefix, std::vector<std::string> tags,
                   std::vector<std::string> raw_values);
    [[nodiscard]] std::string text() const;

private:
    struct Document;
    explicit CifDocument(std::unique_ptr<Document> document);
    std::unique_ptr<Document> document_;
};

// Adds quotes where CIF requires them.
std::string cif_quoted(const std::string& value);

}  // namespace tact
