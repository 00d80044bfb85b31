:- module(test_page_access, []).
:- use_module('../../../lib/common').
:- use_module(library(plunit)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2, nth1/3]).
:- use_module(library(typhon)).
:- use_module('../../../../prolog/typhon/tools/page/guard',
              [ guarding_headers/0, page_file/3, request_own/1,
                request_within/2, token_new/1, token_right/2 ]).
:- use_module('../../../../prolog/typhon/tools/page/server', []).

/** <module> What a request to a page must have, without a server

*Threading*: one test at a time.
*/

:- begin_tests(page_token).

test(token_is_drawn_anew, Lengths == [32,32]) :-
    token_new(A),
    token_new(B),
    A \== B,
    findall(L, ( member(T, [A,B]), atom_length(T, L) ), Lengths).
test(no_other_text_is_the_token, Accepted == ['0f0f']) :-
    findall(G, ( member(G, [ '0f0f', '', '0f0', '0f0f0', '0f0e', '1f0f', 'f0f0',
                             '0F0F', 'ffff', 'f00f' ]),
                 token_right(G, '0f0f') ), Accepted).
test(each_difference_counts, Accepted == []) :-
    findall(G, ( between(1, 4, I), atom_codes(abcd, Codes),
                 nth1(I, Codes, C0), C is C0 xor 1,
                 findall(X,
                         ( nth1(J, Codes, X0), ( I == J -> X = C ; X = X0 ) ),
                         Changed),
                 atom_codes(G, Changed), token_right(G, abcd) ), Accepted).

%   Two differences do not cancel out.

test(differences_are_not_summed_away, [fail]) :-
    token_right(badc, abcd).
test(token_is_in_the_path_the_query_or_the_authorization,
     Rests == [[''],[feed],[a,b],[],[feed],[metrics],no,no,no,no,no,no,no,
               no]) :-
    setup_call_cleanup(
        assertz(typhon_page_server:serving(1, tok, false), Ref),
        findall(Rest, ( request(Parts, Request),
                        admitted(Parts, Request, Rest) ),
                Rests),
        erase(Ref)).

:- end_tests(page_token).

request([tok,''], []).
request([tok,feed], []).
request([tok,a,b], []).
request([''], [search([token=tok])]).
request([feed], [search([token=tok])]).
request([metrics], [authorization('Bearer tok')]).
request([tok], []).
request([''], []).
request([feed], [search([token=other])]).
request([feed], [search([tokens=tok])]).
request([metrics], [authorization('Basic tok')]).
request([metrics], [authorization(tok)]).
request([other,feed], [search([token=tok])]).
request([feed,tok], []).

admitted(Parts, Request, Rest) :-
    (   typhon_page_server:admitted(Parts, Request, Rest0, Token)
    ->  assertion(Token == tok),
        Rest = Rest0
    ;   Rest = no
    ).

:- begin_tests(page_requests).

test(only_this_server_is_an_origin,
     Own == [own,own,own,no,no,no,no,no]) :-
    findall(V, ( member(R, [ [host(h), port(8080)],
                             [origin('http://h:8080'), host(h), port(8080)],
                             [origin('http://h'), host(h), port(80)],
                             [origin('http://h'), host(h), port(8080)],
                             [origin('https://h:8080'), host(h), port(8080)],
                             [origin('http://evil:8080'), host(h), port(8080)],
                             [origin(null), host(h), port(8080)],
                             [origin('http://h:8080')] ]),
                 ( request_own(R) -> V = own ; V = no ) ), Own).
test(bodies_have_a_known_length_within_the_bound,
     Within == [yes,yes,no,no,no]) :-
    findall(V, ( member(R, [ [content_length(0)], [content_length(10)],
                             [content_length(11)], [content_length(x)], [] ]),
                 ( request_within(R, 10) -> V = yes ; V = no ) ), Within).
test(bodies_are_json, Verdicts == [yes,yes,no,no]) :-
    findall(V, ( member(T, [ 'application/json', 'application/json; charset=x',
                             'text/plain', 'text/application/json' ]),
                 ( catch(typhon_page_reception:must_be_json([content_type(T)]),
                         error(domain_error(mimetype, _), _), fail)
                 -> V = yes ; V = no ) ), Verdicts).
test(body_without_a_type_is_refused, [fail]) :-
    typhon_page_reception:must_be_json([]).
test(orders_need_a_page_that_is_not_read_only, Verdicts == [yes,no]) :-
    findall(V, ( member(ReadOnly, [false,true]),
                 setup_call_cleanup(
                     assertz(typhon_page_server:serving(1, tok, ReadOnly), Ref),
                     ( catch(typhon_page_server:may_order(x),
                             error(permission_error(x, page, read_only), _),
                             fail) -> V = yes ; V = no ),
                     erase(Ref)) ), Verdicts).
test(browser_is_told_what_to_refuse, Missing == []) :-
    with_output_to(string(Headers), guarding_headers),
    findall(Text, ( header(Text), \+ sub_string(Headers, _, _, _, Text) ),
            Missing).

:- end_tests(page_requests).

header(Text) :-
    member(Text,
           [ "Content-Security-Policy: default-src 'none'; script-src 'self'; ",
             "style-src 'self'; ", "img-src 'self' data: blob:; ",
             "connect-src 'self'; ", "base-uri 'none'; ",
             "form-action 'none'; ", "frame-ancestors 'none'; ",
             "require-trusted-types-for 'script'; ",
             "trusted-types 'none'\r\n", "X-Content-Type-Options: nosniff\r\n",
             "X-Frame-Options: DENY\r\n", "Referrer-Policy: no-referrer\r\n",
             "Cross-Origin-Opener-Policy: same-origin\r\n",
             "Cross-Origin-Resource-Policy: same-origin\r\n",
             "Cache-Control: no-store\r\n", "Connection: close\r\n" ]).

:- begin_tests(page_files).

test(files_of_the_page_are_served, Deviations == []) :-
    findall(Name,
            ( member(Name-Type, [ ''-'text/html; charset=UTF-8',
                                  'index.html'-'text/html; charset=UTF-8',
                                  'style.css'-'text/css; charset=UTF-8' ]),
              \+ page_file([Name], _, Type) ),
            Deviations).
test(all_files_of_the_folder_have_a_type, Without == []) :-
    www(Dir),
    directory_files(Dir, Files),
    findall(F, ( member(F, Files), \+ sub_atom(F, 0, _, _, '.'),
                 file_name_extension(_, Ext, F),
                 memberchk(Ext, [html,js,css,svg]),
                 \+ page_file([F], _, _) ), Without).

%   The files exist, in the folder or beside it.

test(no_other_file_is_served, Served == []) :-
    with_tmp_dir(served_from(Served)).

:- end_tests(page_files).

www(Dir) :-
    typhon_page_guard:folder(Dir).

served_from(Served, Tmp) :-
    directory_file_path(Tmp, www, Www),
    directory_file_path(Www, sub, Sub),
    make_directory(Www),
    make_directory(Sub),
    forall(member(Name, [ 'a.html', '.hidden.html', 'x.pl', 'x.txt', plain,
                          'sub/b.html', '../c.html', 'd\\e.html' ]),
           ( directory_file_path(Www, Name, File),
             open(File, write, Out), close(Out) )),
    setup_call_cleanup(
        asserta(typhon_page_guard:folder(Www), Ref),
        ( assertion(page_file(['a.html'], _, _)),
          findall(Names,
                  ( member(Names, [ ['.hidden.html'], ['x.pl'], ['x.txt'],
                                    [plain], ['sub/b.html'], [sub,'b.html'],
                                    ['../c.html'], ['..','c.html'],
                                    ['d\\e.html'], ['a.html\x00\.html'],
                                    ['missing.html'], [sub], [], ['.'],
                                    ['..'] ]),
                    page_file(Names, _, _) ),
                  Served) ),
        erase(Ref)).
