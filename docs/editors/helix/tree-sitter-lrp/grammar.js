// Programs of lrp as an editor sees them: forms in round brackets, Lua in square ones. What a form means is not its concern,
// so that half a program is coloured as well as a whole one.

module.exports = grammar({
  name: "lrp",

  extras: $ => [/\s/, $.comment],

  rules: {
    program: $ => repeat($._item),

    _item: $ => choice($.form, $.list, $.block, $.string, $.number, $.arrow, $.assign, $.wildcard, $.name),

    // The first name of a form is a keyword or a mistake; queries tell.
    form: $ => seq("(", field("head", $.name), repeat($._item), ")"),
    list: $ => seq("(", optional(seq(choice($.form, $.list, $.block, $.string, $.number), repeat($._item))), ")"),

    block: $ => seq("[", optional($.lua), "]"),

    // Its end is where Lua sees it: not in a string, a comment or an index.
    lua: $ => repeat1(choice($._lua_text, $._lua_string, $._lua_long, $._lua_comment, $._lua_index)),
    _lua_index: $ => seq("[", repeat(choice($._lua_text, $._lua_string, $._lua_long, $._lua_comment, $._lua_index)), "]"),
    _lua_text: _ => token(prec(-1, choice(/[^\[\]"'\-\s;]+/, "-", ";"))),
    _lua_string: _ => token(choice(/"([^"\\\n]|\\(.|\n))*"/, /'([^'\\\n]|\\(.|\n))*'/)),
    _lua_long: _ => token(choice(/\[\[([^\]]|\][^\]])*\]\]/, /\[=\[([^\]]|\][^=]|\]=[^\]])*\]=\]/)),
    _lua_comment: _ => token(prec(1, choice(/--[^\[\n][^\n]*/, /--\n/, /--\[[^\[=\n][^\n]*/, /--\[\[([^\]]|\][^\]])*\]\]/))),

    string: _ => /"([^"\\]|\\.)*"/,
    number: _ => /\d+(\.\d+)?/,
    arrow: _ => "->",
    assign: _ => ":=",
    wildcard: _ => "*",
    name: _ => /[\p{L}\p{N}_]+(-[\p{L}\p{N}_]+)*/,
    comment: _ => token(prec(-2, /;[^\n]*/)),
  },
});
