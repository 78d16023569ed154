mod lua;
