// What the pictures have in common, so that they are legible on light and on dark pages.
#ifndef BOUGH_APPS_OUTPUT_PICTURE_H
#define BOUGH_APPS_OUTPUT_PICTURE_H

// Follows the <svg> element, as part of a format: the colours of text, of weak text, of grid and axes, and the
// paper. Texts and shapes without a fill of their own have that of text.
#define BOUGH_PICTURE_STYLE                                                                        \
    "<style>svg{fill:#222}.paper{fill:#fff}.weak{fill:#555}.grid{stroke:#ddd;fill:none}"           \
    ".axis{stroke:#222;fill:none}@media (prefers-color-scheme:dark){svg{fill:#e6e6e6}"             \
    ".paper{fill:#12161a}.weak{fill:#aaa}.grid{stroke:#333a42}.axis{stroke:#e6e6e6}}</style>\n"     \
    "<rect class=\"paper\" width=\"100%%\" height=\"100%%\"/>\n"

#endif
