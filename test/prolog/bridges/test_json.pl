:- module(test_json, []).

/** <module> The reader of JSON

The cases are those on which public readers of JSON differ.
*/

:- use_module('../../lib/common').
:- use_module(library(apply), [maplist/2]).
:- use_module(library(lists), [member/2, numlist/3]).
:- use_module(library(plunit)).
:- use_module(library(random), [random_between/3, random_member/2]).
:- use_module(library(typhon/bridges/json), [json_dict/2, json_text/2]).

:- begin_tests(json).

test(value, [forall(value(Text, Value)), true(Read =@= Value)]) :-
    json_dict(Text, Read).

value("[NaN]", [null]).
value("[Infinity,-Infinity]", [null,null]).
value("[1e400,-1e400,1e999999999999]", [null,null,null]).
value("[1e-400,-1e-400]", [0.0,-0.0]).
value("[0.4e00669999999999999999999999999999999999999999969999999006]", [null]).
value("{\"a\":1,\"b\":0,\"a\":2}", _{a:2, b:0}).
value("{\"a\":1,\"\\u0061\":2}", _{a:2}).
value("{\"a\":{\"a\":1,\"a\":[]}}", _{a:_{a:[]}}).
value("{}", _{}).
value("{\"\":0}", _{'':0}).
value("{\"1\":{\"tag\":1}}", _{'1':_{tag:1}}).
value("[\"\\ud83d\\ude00\",\"\\uD834\\uDD1E\"]", ["\U0001F600","\U0001D11E"]).
value("[\"\U0001F600\"]", ["\U0001F600"]).
value("[\"\\ud83d\",\"\\ude00\"]", ["\uFFFD","\uFFFD"]).
value("[\"\\ude00\\ud83d\"]", ["\uFFFD\uFFFD"]).
value("[\"\\ud83dx\",\"\\ud83d\\n\"]", ["\uFFFDx","\uFFFD\n"]).
value("[\"\\ud83d\\ud83d\\ude00\"]", ["\uFFFD\U0001F600"]).
value("[\"\\u0000\\u001f\\uFFFF\"]", ["\u0000\u001f\uFFFF"]).
value("[\"\\\"\\\\\\/\\b\\f\\n\\r\\t\"]", ["\"\\/\b\f\n\r\t"]).
value("[\"\x7f\\u2028\"]", ["\x7f\\u2028"]).
value("[1E5,1e+2,1.5E-1,0e1,123.456e78]", [100000.0,100.0,0.15,0.0,123.456e78]).
value("[-0,-0.0,0.1]", [0,-0.0,0.1]).
value("[5e-324,1.7976931348623157e308]", [5.0e-324,1.7976931348623157e308]).
value("[123456789012345678901234567890]", [123456789012345678901234567890]).
value(" [ 1 ,\t{ \"a\" :\r\nnull } ] \n", [1,_{a:null}]).
value("\uFEFF{\"a\":1}", _{a:1}).
value(Text, ["\uFFFD\uFFFD\u00ff"]) :-
    text_with_halves([0'[,0'",0xD83D,0xDE00,0xFF,0'",0']], Text).
value("\"text\"", "text").
value("true", true).
value("-7", -7).

%   Texts of newer versions of SWI-Prolog have no half pairs.

text_with_halves(Codes, Text) :-
    catch(string_codes(Text, Codes), error(type_error(_, _), _), fail).

test(no_json, [forall(no_json(Text)),
               error(syntax_error(json(illegal_json)))]) :-
    json_dict(Text, _).

no_json(Text) :-
    member(Text,
           [ "", " ", "[", "]", "[1", "[1,", "[1,]", "[,1]", "[1,,2]", "[1 2]",
             "[1]]", "[1] x", "{", "{\"a\"", "{\"a\":", "{\"a\":1", "{\"a\":1,}",
             "{\"a\" 1}", "{a:1}", "{'a':1}", "{1:1}", "{\"a\":1 \"b\":2}",
             "{,}", "[01]", "[-01]", "[1.]", "[.5]", "[+1]", "[-]", "[1e]",
             "[1e+]", "[1.e1]", "[0x10]", "[1_000]", "[1r3]", "[0'a]", "[1 000]",
             "[\uFF11]", "[1.5NaN]", "[1.0Inf]", "[inf]", "[nan]", "[-NaN]",
             "[nul]", "[True]", "[true1]", "[\"\t\"]", "[\"\n\"]", "[\"\\x\"]",
             "[\"\\u12\"]", "[\"\\u12g4\"]", "[\"\\u\uFF11111\"]", "[\"\\\"]",
             "[\"", "['a']", "[/**/1]", "// x", "\uFEFF", "\uFEFF\uFEFF[]", "[\uFEFF]", "[\u00a0]",
             "[1]\u0000", "f(x)", "_", "[X]" ]).

%   Texts of any depth and numbers of any length take time in proportion to
%   their length, and stay small for the programs that get the term.

test(deep, [forall(member(Pair, ["[]", "{\"a\":}"])), Depths == [600,600]]) :-
    nested(Pair, 600, Text),
    json_dict(Text, Term),
    depth(Term, Depth),
    json_text(Term, Written),
    json_dict(Written, Again),
    depth(Again, Depth1),
    Depths = [Depth,Depth1].
test(too_deep, [forall(member(Depth, [601,100000])),
                error(syntax_error(json(illegal_json)))]) :-
    nested("[]", Depth, Text),
    json_dict(Text, _).
test(deep_and_open, error(syntax_error(json(illegal_json)))) :-
    repeated("[", 100000, Text),
    json_dict(Text, _).
test(too_deep_to_write, error(type_error(json_value, [[]]))) :-
    nested("[]", 600, Text),
    json_dict(Text, Term),
    json_text([[Term]], _).
test(long_numbers, [Length,Rest] == [4300,[null,null,-1]]) :-
    repeated("1", 4300, Longest),
    repeated("1", 1000000, Long),
    format(string(Text), "[~s,~s,0.~s,-1]", [Longest,Long,Long]),
    json_dict(Text, [Number|Rest]),
    atom_length(Number, Length).

%   Pair ends with one character that closes.

nested(Pair, Depth, Text) :-
    sub_string(Pair, Before, 1, 0, Close),
    sub_string(Pair, 0, Before, _, Open),
    repeated(Open, Depth, Opened),
    repeated(Close, Depth, Closed),
    (   Open == "["
    ->  Middle = ""
    ;   Middle = "null"
    ),
    atomic_list_concat([Opened,Middle,Closed], Text).

repeated(Part, Count, Text) :-
    length(Parts, Count),
    maplist(=(Part), Parts),
    atomic_list_concat(Parts, Text).

depth([Term], Depth) => depth(Term, Depth1), Depth is Depth1+1.
depth(_{a:Term}, Depth) => depth(Term, Depth1), Depth is Depth1+1.
depth([], Depth) => Depth = 1.
depth(null, Depth) => Depth = 0.

%   Flags that a program sets change neither numbers nor their absence.

test(flags, Term == [null,100000.0,0.0]) :-
    with_flag(float_overflow, infinity,
              with_flag(iso, true, json_dict("[1e400,1e5,0e0]", Term))).

with_flag(Flag, Value, Goal) :-
    current_prolog_flag(Flag, Old),
    setup_call_cleanup(set_prolog_flag(Flag, Value), Goal,
                       set_prolog_flag(Flag, Old)).

test(no_json_value, [forall(no_value(Term, Culprit)),
                     error(type_error(json_value, Culprit))]) :-
    json_text([_{a:[Term]}], _).

no_value(Inf, Inf) :- Inf is inf.
no_value(Inf, Inf) :- Inf is -inf.
no_value(NaN, NaN) :- NaN is nan.
no_value(f(x), f(x)).
no_value(a-1, a-1).
no_value([1|b], [1|b]).
no_value(1r3, 1r3).
no_value(_{1:a}, _{1:a}).
no_value(json([a]), json([a])).

test(unbound, error(instantiation_error)) :-
    json_text([_], _).
test(half_a_pair_is_not_written, [forall(text_with_halves([0xD83D], Half)),
                                  error(representation_error(_))]) :-
    json_text([Half], _).
test(control_characters_are_escaped, Raw-Read == []-String) :-
    numlist(0, 0x9f, Codes),
    string_codes(String, Codes),
    json_text(String, Text),
    string_codes(Text, Written),
    findall(Code, ( member(Code, Written), Code < 0x20 ), Raw),
    json_dict(Text, Read).
test(members_keep_their_order) :-
    json_text(json([b=1,a=2]), Text),
    sub_string(Text, B, _, _, "\"b\""),
    sub_string(Text, A, _, _, "\"a\""),
    assertion(B < A).

test(written_terms_are_read, Lost == []) :-
    findall(Term, ( between(1, 300, _),
                    term(4, Term),
                    json_text(Term, Text),
                    \+ ( json_dict(Text, Read), Read =@= Term ) ),
            Lost).

term(Depth, Term) :-
    random_between(0, Depth, Kind),
    Depth1 is Depth-1,
    term(Kind, Depth1, Term).

term(0, _, Atom) :- random_member(Atom, [true,false,null]).
term(1, _, Text) :- text(Text).
term(2, _, Number) :-
    random_between(-20, 20, Power),
    random_between(-1000, 1000, N),
    random_member(Number0, [N, N*10.0**Power, N*10**20]),
    Number is Number0.
term(3, Depth, List) :-
    random_between(0, 4, Length),
    length(List, Length),
    maplist(term(Depth), List).
term(4, Depth, Dict) :-
    term(3, Depth, Values),
    findall(Key-Value,
            ( member(Value, Values), text(Text), atom_string(Key, Text) ),
            Pairs),
    sort(1, @<, Pairs, Unique),
    dict_pairs(Dict, _, Unique).

text(Text) :-
    random_between(0, 5, Length),
    length(Codes, Length),
    maplist(code, Codes),
    string_codes(Text, Codes).

code(Code) :-
    random_member(Low-High, [0-0x1f, 0x20-0x7e, 0x80-0x2fff, 0xe000-0xffff,
                             0x10000-0x10ffff]),
    random_between(Low, High, Code).

:- end_tests(json).
