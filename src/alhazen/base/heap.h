#pragma once
/// The heap of a program, made ready by its `main`.

namespace alhazen {

/// Takes the first part of the heap at once, in large pages, and keeps what is freed for the next
/// use: vectors that grow, or are made one after the other, do not touch each page anew. Does
/// nothing where the C library is not glibc.
void prepare_heap();

}  // namespace alhazen
