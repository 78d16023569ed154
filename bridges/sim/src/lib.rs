//! A differential-drive robot in a small world read from a text file. Knows nothing of lrp.
