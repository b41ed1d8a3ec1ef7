#include "crane/report/page.hpp"

#include <array>
#include <cmath>
#include <cstdio>

#include "assets.hpp"
#include "crane/files/complete_file.hpp"
#include "plot_data.hpp"

namespace crane::report {
namespace {

std::string escaped(std::string_view text) {
  std::string html;
  for (const char c : text) switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  return html;
}

/// Escapes '<' in JSON, because '<' could end the enclosing script element.
std::string escaped_json(const nlohmann::ordered_json& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace))
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  return text;
}

const char* class_of(Tone tone) {
  switch (tone) {
    case Tone::neutral:
      return "neutral";
    case Tone::good:
      return "good";
    case Tone::bad:
      return "bad";
    case Tone::muted:
      return "muted";
  }
  return "neutral";
}

bool begins_like_a_number(const std::string& text) {
  const std::size_t first = text.starts_with('-') || text.starts_with('+') ? 1 : 0;
  return text == "-" || (text.size() > first && text[first] >= '0' && text[first] <= '9');
}

std::string decimals(double value, int digits) {
  if (std::isnan(value)) return "-";
  std::array<char, 400> text{};
  std::snprintf(text.data(), text.size(), "%.*f", digits, value);
  return text.data();
}

std::string heading(const std::string& title) {
  return title.empty() ? "" : "<h3>" + escaped(title) + "</h3>\n";
}

std::string row_of(const std::vector<Cell>& cells) {
  std::string html = "<tr>";
  for (const Cell& cell : cells)
    html += std::string{"<td class=\""} + class_of(cell.tone) +
            (begins_like_a_number(cell.text) ? " number" : "") + "\">" + escaped(cell.text) + "</td>";
  return html + "</tr>\n";
}

struct ToHtml {
  std::string operator()(const Paragraph& paragraph) const {
    return "<p class=\"wide\">" + escaped(paragraph.text) + "</p>\n";
  }
  std::string operator()(const Verdict& verdict) const {
    return std::string{"<p class=\"wide verdict "} + class_of(verdict.tone) + "\">" + escaped(verdict.text) +
           "</p>\n";
  }
  std::string operator()(const Table& table) const {
    std::string html = "<div class=\"wide\">" + heading(table.title) + "<table>\n<thead><tr>";
    for (const std::string& text : table.header) html += "<th>" + escaped(text) + "</th>";
    html += "</tr></thead>\n<tbody>\n";
    for (const auto& row : table.rows) html += row_of(row);
    return html + "</tbody>\n</table></div>\n";
  }
  std::string operator()(const LinePlot& plot) const {
    return "<div class=\"plot\">" + heading(plot.title) + "<script type=\"application/json\">" +
           escaped_json(to_json(plot)) + "</script></div>\n";
  }
  std::string operator()(const Picture& picture) const {
    if (!picture.svg.starts_with("<svg"))
      throw std::invalid_argument("picture \"" + picture.title + "\": does not begin with <svg");
    return "<div class=\"picture\">" + heading(picture.title) + picture.svg + "</div>\n";
  }
};

std::string section_of(const Section& section) {
  const std::string title = "<h2>" + escaped(section.title) + "</h2>";
  std::string html =
      section.folded ? "<details><summary>" + title + "</summary>\n" : "<section>" + title + "\n";
  html += "<div class=\"blocks\">\n";
  for (const Block& block : section.blocks) html += std::visit(ToHtml{}, block);
  return html + "</div>\n" + (section.folded ? "</details>\n" : "</section>\n");
}

}  // namespace

Cell with_interval(double value, double low, double high, int digits, Tone tone) {
  return {decimals(value, digits) + " [" + decimals(low, digits) + ", " + decimals(high, digits) + "]", tone};
}

Cell number(double value, int digits, Tone tone) { return {decimals(value, digits), tone}; }

std::string to_html(const Page& page) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      // This policy prevents every load from a network, for any content of the texts.
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
      "script-src 'unsafe-inline'; img-src data:\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
      escaped(page.title) + "</title>\n<style>\n" + assets::uplot_style + assets::page_style +
      "</style>\n</head>\n<body>\n<h1>" + escaped(page.title) + "</h1>\n";
  if (!page.summary.empty()) html += "<p>" + escaped(page.summary) + "</p>\n";
  for (const Section& section : page.sections) html += section_of(section);
  return html + "<noscript><p>The plots of this page need JavaScript.</p></noscript>\n<script>\n" +
         assets::uplot_script + "\n" + assets::page_script + "</script>\n</body>\n</html>\n";
}

void write_html(const std::filesystem::path& file, const Page& page) {
  files::write_file(file, to_html(page));
}

}  // namespace crane::report
