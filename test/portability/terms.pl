/* One term of every kind, as each host of the ring reads them for itself
   into its place. The terms that an agent brings are compared with these.
*/

:- use_module(library(apply), [foldl/4]).
:- use_module(library(lists), [member/2, numlist/3]).

%!  term(?Name, -Term) is nondet.

term(small, [0, 1, -1, 7, -7]).
term(edges, Integers) :-
    findall(I,
            ( member(Bits, [8, 15, 23, 24, 25, 29, 30, 31, 32, 52, 53, 55,
                            56, 57, 59, 60, 61, 62, 63, 64, 65, 127, 128]),
              member(Sign, [1, -1]),
              member(Off, [-1, 0, 1]),
              I is Sign*2**Bits+Off
            ),
            Integers).
term(literals, [ 16777216, -16777217, 2147483648, -2147483649, 4294967296,
                 72057594037927936, 9223372036854775807,
                 -9223372036854775808, 9223372036854775808,
                 -9223372036854775809, 18446744073709551616
               ]).
term(big, [Big, Negative]) :-
    Big is 3**500,
    Negative is -(7**300).
term(rationals, [Third, Negative, Large]) :-
    Third is 1 rdiv 3,
    Negative is -22 rdiv 7,
    Large is (2**100+1) rdiv 3**50.
term(floats, [ 0.1, -0.1, 1.0, 0.30000000000000004, 1.0e22, 1.0e23,
               123456789012345680.0, 2.2250738585072014e-308, 5.0e-324,
               -5.0e-324, 1.7976931348623157e308, 9007199254740993.0
             ]).
term(computed, [Pi, E, Third, Root]) :-
    Pi is pi,
    E is e,
    Third is 1/3.0,
    Root is sqrt(2.0).
term(infinite, [Inf, Negative]) :-
    Inf is inf,
    Negative is -inf.
term(nan, NaN) :-
    NaN is nan.
term(zeros, [0.0, -0.0, 0]).
term(strings, [ "", "text", "it's \"quoted\"", "back\\slash", "a\nb\tc\r",
                "nul \0\ inside", "\e\a\b\f\v", "d\u00E9j\u00E0 \u4E00",
                "\U0001F600", "\u200D\uFEFF", " ", "%", "/* x */", "."
              ]).
term(atoms, [ a, 'A', '_', '_a', '', ' ', 'hello world', 'it''s', '"', '`',
              'back\\slash', 'a\nb', 'nul \0\ inside', '\e', '.', 'a.', '%',
              '/*', '0', '1.5', '0''a', 'd\u00E9j\u00E0', '\u00C9t\u00E9',
              '\u4E00\u4E8C', '\U0001F600', '\u0394', '\u200D', end_of_file
            ]).
term(brackets, [[], '[]', {}, '{}', '()', '[', ']', '{', '}', '(', ')']).
term(symbols, [!, ;, (','), '|', (:-), (?-), (-->), -, +, *, \, (\+), =, ==,
               (->), (*->), (dynamic), is, mod, rdiv, ^, **, @, #, &, $, ?,
               :, ~, (<), '...', '!!', ',,'
              ]).
term(operators, [ (a:-b,c), (:-a), (a;b->c), (a*->b;c), \+a, \+ (a,b), - 1,
                  -(1), -(-(1)), 1-(-1), -a, -(-(a)), 2**(-1), (-2)**2,
                  -(2)^2, 1-(2-3), 1-2-3, a=(:-), f(:-), f((a:-b)),
                  f((a,b)), [(a,b)|c], [-], -(-), \ (-), (-)-(-), {a,b},
                  {-}, '{}'(x,y), (dynamic a), a:b:c, (a-->b), 1 = :- ,
                  - (1.5), - (a), 1 rdiv 2, 2 - (-(2)), @(a), ?(a)
                ]).
term(own_operators, ['===>'(a,b), '===>'(b), '===>', prefix(a),
                     '===>'(prefix(a), prefix(-))]).
term(compounds, [ f(x), 'F G'(x), ''(x), []([]), '[]'(x), '[]'(x,y),
                  '\u4E00'("\u4E00"), -(a,b,c), ','(a), ','(a,b,c),
                  '|'(a,b), ';'(a), '.'(a)
                ]).
term(no_arguments, Terms) :-
    findall(Term,
            ( member(Name, [foo, 'F G', [], '[]', {}, -, (:-), '', '\u4E00']),
              compound_name_arguments(Term, Name, [])
            ),
            Terms).
term(dots, [Pair, List]) :-            % in a clause it would be evaluated
    compound_name_arguments(Pair, '.', [a,b]),
    compound_name_arguments(List, '.', [a,[]]).
term(numbered, ['$VAR'(0), '$VAR'(27), '$VAR'(-1), '$VAR'('Foo'),
                '$VAR'("x"), '$VAR'(x), '$VAR', '$VAR'(_), '$VAR'(1,2)]).
term(variables, f(X, Y, X, g(Y, _, Z), [Z|Tail], Tail)).
term(lists, [[a], [a|b], [a|_], [[], [[]]], [[a,b]|[c]], "abc", `abc`,
             ['.'], '[|]', '[|]'(a), '[|]'(a,b), '[|]'(a,b,c)]).
term(long, List) :-
    numlist(1, 5000, List).
term(deep, Term) :-
    numlist(1, 2000, List),
    foldl(deeper, List, 0, Term).
term(wide, Term) :-
    numlist(1, 1000, List),
    compound_name_arguments(Term, wide, List).

deeper(I, Term, s(Term,I)).

%!  same(+Name, @Term) is semidet.
%
%   Term equals the one of term/2 for Name: bit for bit, with variables shared
%   alike.

same(Name, Term) :-
    term(Name, Expected),
    Term =@= Expected,
    text(Term, Text),
    text(Expected, Text).

text(Term0, Text) :-
    copy_term(Term0, Term),
    term_variables(Term, Variables),
    foldl(name_variable, Variables, 0, _),
    format(string(Text), '~k', [Term]).

name_variable('a variable'(N), N, N1) :-
    N1 is N+1.
