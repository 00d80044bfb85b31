:- module(test_shown_text, []).
:- use_module('../../../lib/common').
:- use_module('../../../lib/fixtures').
:- use_module('../../../lib/peers').
:- use_module('../../../../prolog/typhon/kernel/base/error_lines').
:- use_module('../../../../prolog/typhon/kernel/base/text').
:- use_module(library(plunit)).
:- use_module(library(debug)).
:- use_module(library(filesex), [directory_file_path/3]).
:- use_module(library(lists), [member/2]).
:- use_module(library(process), [process_create/3]).
:- use_module(library(random), [random_member/2]).
:- use_module(library(readutil), [read_file_to_string/3, read_file_to_terms/3]).
:- use_module(library(typhon)).
:- use_module(library(typhon/tools/tables), []).

/** <module> No text of an agent or a peer controls the terminal

*Threading*: one test at a time.
*/

%   wicked(-Code): a terminal obeys it, or a reader does not see it.

wicked(Code) :- between(0, 31, Code).
wicked(Code) :- between(127, 159, Code).
wicked(Code) :-
    member(Code, [ 0xad, 0x61c, 0x180e, 0x200b, 0x200e, 0x200f, 0x2028, 0x2029,
                   0x202a, 0x202e, 0x2060, 0x2066, 0x2069, 0xfeff, 0xfff9,
                   0xe0001, 0xe0041 ]).

%   random_name(-Name): an atom with a wicked character among others.

random_name(Name) :-
    findall(Code, wicked(Code), Codes),
    random_member(Wicked, Codes),
    random_member(Before, ["", "a", "[2J", "\u00e9~w", "~n"]),
    random_member(After, ["", "b", "]0;x", "\u4e2d", "\nERROR: b"]),
    format(atom(Name), '~s~c~s', [Before, Wicked, After]).

%   term_of(+Name, -Term): an error or message that holds Name.

term_of(N, error(Formal, Context)) :-
    member(Formal-Context,
           [ type_error(N, x)-_, type_error(x, N)-context(N/1, N),
             domain_error(N, f(N))-context(_, N), existence_error(N, N)-_,
             existence_error(host, N)-_, existence_error(agent, N)-_,
             existence_error(x, N, N)-_,
             permission_error(N, N, N)-context(_, N),
             representation_error(N)-_, evaluation_error(N)-_,
             resource_error(N)-_, syntax_error(N)-string(N, 0),
             syntax_error(x)-file(N, 1, 2, 3), timeout_error(N, N)-_,
             io_error(N, N)-context(N, N), socket_error(x, N)-_,
             system_error(N)-_, shell(N, N)-_, move_refused(N, N)-_,
             host_unreachable(N)-_, N-N ]).
term_of(N, unhandled_exception(Ball)) :-
    member(Ball, [N, error(type_error(N, N), _)]).
term_of(N, typhon(Message)) :-
    member(Message,
           [ raised(N), told(N, N), log(N, N, f(N)), over_limit(N, N),
             message_failed(N, N, N), not_from(N, N, N), log_unheard(N), N,
             undeliverable(existence_error(agent, N), N, N, N),
             traced(N, N, sent(N, N)) ]).

as_printed(Term, Text) :-
    '$messages':translate_message(Term, Lines, []),
    with_output_to(string(Text),
                   print_message_lines(current_output, 'E ', Lines)).

%   is_clean(+Text): all lines begin with the prefix, and have no wicked
%   character.

is_clean(Text0) :-
    split_string(Text0, "", "\n", [Text]),
    forall(( string_code(_, Text, Code), Code =\= 10 ), \+ wicked(Code)),
    split_string(Text, "\n", "", Lines),
    forall(member(Line, Lines), string_concat("E ", _, Line)),
    \+ ( member(Line, Lines), string_concat("E ERROR", _, Line) ).

string_code(I, Text, Code) :-
    string_length(Text, Length),
    between(1, Length, I),
    string_code_at(I, Text, Code).

string_code_at(I, Text, Code) :-
    system:string_code(I, Text, Code).

escaping(Found) :-
    findall(Term-Text,
            ( between(1, 40, _), random_name(Name), term_of(Name, Term),
              as_printed(Term, Text), \+ is_clean(Text) ),
            Found).

%   classified(-Class, -Code): Code is `hidden` according to the database of
%   Unicode, or visible, and next to one that is hidden.  Some letters and marks
%   are shown as nothing.

classified(hidden, Code) :-
    member(Code, [ 0x34f, 0x115f, 0x1160, 0x17b4, 0x17b5, 0x180b, 0x180c,
                   0x180d, 0x3164, 0xffa0 ]).
classified(Class, Code) :-
    python(Python),
    atomic_list_concat(
        [ 'import unicodedata as u',
          'def category(i): return u.category(chr(i))',
          'hidden = [i for i in range(0x110000)',
          '          if category(i) in ("Cc", "Cf", "Zl", "Zp")]',
          'for i in hidden: print(f"hidden({i}).")',
          'near = {j for i in hidden for j in (i-1, i+1) if 0 <= j < 0x110000}',
          'for i in near:',
          '    if category(i)[0] in "LMNPS" and not 0x180d <= i <= 0x180f:',
          '        print(f"visible({i}).")'
        ], '\n', Script),
    setup_call_cleanup(
        process_create(Python, ['-c', Script], [stdout(pipe(Out))]),
        read_term_list(Out, Terms),
        close(Out)),
    member(Term, Terms),
    Term =.. [Class,Code].

read_term_list(In, Terms) :-
    read(In, Term),
    (   Term == end_of_file
    ->  Terms = []
    ;   Terms = [Term|Rest],
        read_term_list(In, Rest)
    ).

%   printable_as(+Class, +Code): Code is not treated as one of Class.

printable_as(Class, Code) :-
    char_code(Char, Code),
    (   is_printable(Char)
    ->  Class == hidden
    ;   Class == visible
    ).

:- begin_tests(shown_text).

test(no_message_has_hidden_characters, Found == []) :-
    escaping(Found).
test(no_error_text_has_hidden_characters, Found == []) :-
    findall(Error-Text,
            ( between(1, 40, _), random_name(Name), term_of(Name, Error),
              error_text(Error, Text0), string_concat("E ", Text0, Text1),
              split_string(Text1, "\n", "", [Line|_]),
              Text = Line, \+ is_clean(Text) ),
            Found).
test(invisible_characters_are_not_printable, Wrong == []) :-
    findall(Class-Code, ( classified(Class, Code), printable_as(Class, Code) ),
            Wrong).
test(letters_stay_readable, Text == "Zo\u00eb \u4e2d\u6587 \U0001F600 \u043c") :-
    shown_text('Zo\u00eb \u4e2d\u6587 \U0001F600 \u043c', Text).
test(escapes, Text == "a\\nb\\x1B\\[2J\\x202E\\") :-
    shown_text('a\nb\e[2J\u202e', Text).
test(arguments_keep_their_type, Text == "a b 'B' \"s\"\n") :-
    formatted('~w ~q ~q ~q~n', [a, b, 'B', "s"], Text).
test(length_is_bounded, [forall(member(Char, [a,'\e'])), true(Length == 10 000)]) :-
    length(Chars, 100 000),
    maplist(=(Char), Chars),
    atom_chars(Long, Chars),
    shown_text(Long, Text),
    string_length(Text, Length).
test(messages_are_bounded, true(Length < 25 000)) :-
    format(atom(Long), '~*c', [1 000 000, 0'a]),
    as_printed(error(type_error(Long, Long), _), Text),
    string_length(Text, Length).
test(debug_messages, Clean == true) :-
    with_tmp_dir(debugged('a\e[2J', Text)),
    ( sub_string(Text, _, _, _, "\e") -> Clean = Text ; Clean = true ).
test(messages_without_them_are_unchanged, true(Line == "~w at ~w: "-[b,a])) :-
    '$messages':translate_message(typhon(log(a, b, c)), Lines, []),
    Lines = [Format-Args|_],
    atom_string(Format, Text),
    Line = Text-Args.
test(names_of_hosts, [ forall(member(Name, ['a\nb', 'a\e[2J', 'a\u202eb', ''])),
                       error(domain_error(host_name, _)) ]) :-
    host_start(Name).
test(names_of_log_servers, error(domain_error(log_server_name, _))) :-
    log_server_start([name('a\nb'), file('/nowhere/x')], _).
test(addresses, error(existence_error(host, _))) :-
    with_hosts([h], remote('a\nb@127.0.0.1:1', true)).
test(errors_of_another_process, Found == []) :-
    no_leaks(with_peers([p-[host([])]], with_hosts([h],
        findall(Text,
                ( peer_host(p, There),
                  between(1, 20, _), random_name(Name),
                  member(Ball, [ type_error(Name, x), resource_error(Name),
                                 existence_error(Name, Name) ]),
                  catch(remote(There, throw(error(Ball, context(_, Name)))),
                        Error, true),
                  as_printed(unhandled_exception(Error), Text),
                  \+ is_clean(Text) ),
                Found)))).
test(agents_write_no_over_into_the_audit, Found == []) :-
    with_tmp_dir(raised_on_host(Found)).
test(audit_is_bounded_and_printable, Found == []) :-
    with_tmp_dir(audited(Found)).

:- end_tests(shown_text).

debugged(Text, Printed, Dir) :-
    directory_file_path(Dir, debug, File),
    setup_call_cleanup(
        ( open(File, write, Out, [encoding(utf8)]),
          debug(typhon(test) > Out) ),
        debug(typhon(test), '~w~n', [Text]),
        ( nodebug(typhon(test)), close(Out) )),
    read_file_to_string(File, Printed, [encoding(utf8)]).

%   Agents raise errors as quotas do.

raised_on_host(Found, Dir) :-
    directory_file_path(Dir, audit, Audit),
    with_hosts([ h-[ audit(Audit),
                     quota([ messages(5), seconds(20), inferences(100 000 000),
                             state(1 000 000), stack(64 000 000) ]) ] ],
               capturing(forall(forged(Ball), ended_by(Ball)), _)),
    entries(Audit, Found).

forged(error(resource_error(What), _)) :-
    member(What, [messages, seconds, stack, state, program_space, inferences,
                  'any text', hops, lifetime]).
forged(error(resource_error(stack), context(_, _))).
forged(inference_limit_exceeded).

ended_by(Ball) :-
    create([ (main :- throw(Ball)) ], A, [host(h)]),
    wait_until(( \+ agent_property(A, _) ; state_of(A, faulty(_)) ), 20),
    catch(agent_dispose(A), error(_, _), true).

entries(File, Entries) :-
    (   exists_file(File)
    ->  read_file_to_terms(File, Entries, [encoding(utf8)])
    ;   Entries = []
    ).

%   Names and reasons that a refused agent chooses.

audited(Found, Dir) :-
    directory_file_path(Dir, audit, Audit),
    format(atom(Long), '~*c', [100 000, 0'a]),
    with_hosts([h-[audit(Audit), tokens([t])]],
               forall(( between(1, 30, _), random_name(Name) ),
                      ( typhon_rights:security_event(h, refused(Name, Name)),
                        typhon_rights:security_event(h, refused(Long, Name))
                      ))),
    read_file_to_string(Audit, Text, [encoding(utf8)]),
    split_string(Text, "\n", "", Lines),
    findall(Line, ( member(Line, Lines), wicked_line(Line) ), Found).

wicked_line(Line) :-
    string_length(Line, Length),
    Length > 3000.
wicked_line(Line) :-
    string_code(_, Line, Code),
    wicked(Code).
wicked_line(Line) :-
    Line \== "",
    \+ catch(( term_string(Term, Line), Term = audit(_, h, _, _, _) ),
             error(_, _), fail).
