#include "view_page.h"

#include "alhazen/explain/page/explanation_page.h"

namespace alhazen::viewer {

std::vector<Asset> view_page() {
    return {{"/", "text/html; charset=utf-8", to_string(kViewPage)},
            {"/view.js", "text/javascript; charset=utf-8", to_string(kViewScript)},
            {"/view.css", "text/css; charset=utf-8",
             to_string(kExplanationStyle) + to_string(kViewStyle)}};
}

}  // namespace alhazen::viewer
