// The version that `bough --version` and summary.json tell; tests/cli/test_cli.sh holds it against the
// build's.
#ifndef BOUGH_APPS_BOUGH_VERSION_H
#define BOUGH_APPS_BOUGH_VERSION_H

#define BOUGH_VERSION "0.1.0"

#endif
