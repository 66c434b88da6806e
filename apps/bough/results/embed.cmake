# Turns the file IN into the C array bough_report_page in OUT.
file(READ ${IN} bytes HEX)
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "0x\\1," bytes "${bytes}")
file(WRITE ${OUT} "#include \"apps/bough/results/report.h\"\n"
  "const unsigned char bough_report_page[] = {${bytes}0};\n")
