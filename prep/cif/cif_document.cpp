#include "prep/cif/cif_document.hpp"

#include <gemmi/cif.hpp>
#include <gemmi/to_cif.hpp>
#include <sstream>
#include <utility>

namespace tact {

namespace cif = gemmi::cif;

struct CifTable::Table {
    cif::Table table;
    // gemmi::cif::Table::operator[] is not const; the row only refers to the document.
    [[nodiscard]] cif::Table::Row row(std::size_t row) const {
        return const_cast<cif::Table&>(table)[static_cast<int>(row)];
    }
};

struct CifDocument::Document {
    cif::Document document;
};

CifTable::CifTable(std::unique_ptr<Table> table) : table_(std::move(table)) {}
CifTable::CifTable(CifTable&&) noexcept = default;
CifTable& CifTable::operator=(CifTable&&) noexcept = default;
CifTable::~CifTable() = default;

std::size_t CifTable::rows() const { return table_->table.length(); }

bool CifTable::has(std::size_t column) const { return table_->table.has_column(static_cast<int>(column)); }

const std::string& CifTable::raw(std::size_t row, std::size_t column) const {
    return table_->row(row).value_at(table_->table.positions[column]);
}

bool CifTable::known(std::size_t row, std::size_t column) const { return table_->row(row).has2(column); }

std::string CifTable::value(std::size_t row, std::size_t column) const {
    return known(row, column) ? cif::as_string(raw(row, column)) : std::string();
}

void CifTable::set(std::size_t row, std::size_t column, std::string raw) {
    table_->row(row).value_at(table_->table.positions[column]) = std::move(raw);
}

CifDocument::CifDocument(std::unique_ptr<Document> document) : document_(std::move(document)) {}
CifDocument::CifDocument(CifDocument&&) noexcept = default;
CifDocument& CifDocument::operator=(CifDocument&&) noexcept = default;
CifDocument::~CifDocument() = default;

CifDocument CifDocument::read(std::string_view text, const std::string& name) {
    auto document = std::make_unique<Document>();
    document->document = cif::read_memory(text.data(), text.size(), name.c_str());
    return CifDocument(std::move(document));
}

CifDocument CifDocument::with_block(const std::string& name) {
    auto document = std::make_unique<Document>();
    document->document.blocks.emplace_back(name);
    return CifDocument(std::move(document));
}

std::size_t CifDocument::blocks() const { return document_->document.blocks.size(); }

CifTable CifDocument::table(std::size_t block, const std::string& prefix,
                            const std::vector<std::string>& tags) {
    return CifTable(std::make_unique<CifTable::Table>(
        CifTable::Table{document_->document.blocks[block].find(prefix, tags)}));
}

void CifDocument::set_pair(std::size_t block, const std::string& tag, const std::string& value) {
    document_->document.blocks[block].set_pair(tag, cif::quote(value));
}

void CifDocument::erase(std::size_t block, const std::vector<std::string>& prefixes) {
    for (cif::Item& item : document_->document.blocks[block].items)
        for (const std::string& prefix : prefixes)
            if (item.has_prefix(prefix)) item.erase();
}

void CifDocument::add_table(std::size_t block, const std::string& prefix, std::vector<std::string> tags,
                            std::vector<std::string> raw_values) {
    document_->document.blocks[block].init_loop(prefix, std::move(tags)).values = std::move(raw_values);
}

std::string CifDocument::text() const {
    std::ostringstream out;
    cif::write_cif_to_stream(out, document_->document);
    return out.str();
}

std::string cif_quoted(const std::string& value) { return cif::quote(value); }

}  // namespace tact
