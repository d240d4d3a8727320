/* SPDX-License-Identifier: BSD-3-Clause */
/** One self-contained HTML page around the data of a report: no network, no file beside it. */
#ifndef CURVE_PROXIMITY_CLI_REPORT_PAGE_H
#define CURVE_PROXIMITY_CLI_REPORT_PAGE_H

#include <string>

namespace curve_proximity::cli {

/** The page. title: plain text. data: JSON, which report/page.js reads; it says there what it expects. Takes three.js
 * from where libjs-three installs it. Throws BadUsage where that is not installed. */
std::string reportPage(const std::string &title, const std::string &data);

} // namespace curve_proximity::cli
#endif
