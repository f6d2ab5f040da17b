# cmake -DFOLDER=... -DFUNCTION=... -DOUTPUT=... -P embed_folder.cmake: see PosevoteEmbed.cmake. The
# assembler includes the bytes; the hashes make the source differ when a file does.
file(GLOB_RECURSE paths RELATIVE ${FOLDER} ${FOLDER}/*)
list(SORT paths)
set(data "")
set(names "")
set(entries "")
set(number 0)
foreach(path IN LISTS paths)
  set(symbol ${FUNCTION}_${number})
  file(SHA256 ${FOLDER}/${path} hash)
  string(APPEND data "asm(\".section .rodata\\n.global ${symbol}\\n${symbol}:\\n.incbin \\\"${FOLDER}/${path}\\\"\\n\"
    \".global ${symbol}_end\\n${symbol}_end:\\n.byte 0\\n.previous\\n\");\n")
  string(APPEND names "extern \"C\" const char ${symbol}[], ${symbol}_end[];\n")
  string(APPEND entries "      {\"${path}\", {${symbol}, static_cast<std::size_t>(${symbol}_end - ${symbol})},\n       \"${hash}\"},\n")
  math(EXPR number "${number} + 1")
endforeach()
file(WRITE ${OUTPUT} "#include \"embedded.hpp\"

${data}
${names}
namespace posevote::server {

const std::vector<EmbeddedFile>& ${FUNCTION}() {
  static const std::vector<EmbeddedFile> files{
${entries}  };
  return files;
}

}  // namespace posevote::server
")
