# Joins the modules in the one library that is installed.
