# Same input, same bits. A compiler that contracts a*b+c to a fused multiply-add where it likes gives other last digits
# in other builds, so contraction is off everywhere; no -ffast-math, ever.
add_compile_options(-ffp-contract=off -fno-math-errno)
add_compile_definitions($<$<CONFIG:Debug,RelWithDebInfo>:EMBODY_ASSERTIONS>)
add_compile_definitions($<$<OR:$<CONFIG:Debug>,$<BOOL:${EMBODY_FUZZ_COVERAGE}>>:EMBODY_VALIDATION>)
