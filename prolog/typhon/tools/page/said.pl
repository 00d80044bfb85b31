:- module(typhon_page_said,
          [ saying/2,                   % :Goal, -Messages
            on_console/1                % :Goal
          ]).

/** <module> What is printed while something is done

Messages of a thread that serves a browser are kept for that browser, and not
printed at the terminal.

*Threading*: any thread, for itself.
*/

:- meta_predicate
    saying(0, -),
    on_console(0).

:- thread_local said/3.                 % Kind, Term, Text

:- multifile user:thread_message_hook/3.
:- thread_local user:thread_message_hook/3.

%!  saying(:Goal, -Messages:list) is semidet.
%
%   As once(Goal).  Messages are the errors and warnings that it prints in this
%   thread, terms said(Kind, Term, Text).  They are not printed, and what only
%   informs is neither.

saying(Goal, Messages) :-
    retractall(said(_, _, _)),
    setup_call_cleanup(
        assertz((user:thread_message_hook(Term, Kind, Lines) :-
                     typhon_page_said:keep(Kind, Term, Lines)), Hook),
        once(Goal),
        erase(Hook)),
    findall(said(Kind, Term, Text), retract(said(Kind, Term, Text)),
            Messages).

:- public keep/3.

keep(informational, _, _) :-
    !.
keep(Kind, Term, Lines) :-
    memberchk(Kind, [error, warning]),
    with_output_to(string(Text0),
                   print_message_lines(current_output, '', Lines)),
    split_string(Text0, "", " \n", [Text]),
    assertz(said(Kind, Term, Text)).

%!  on_console(:Goal) is semidet.
%
%   As once(Goal), with the output of the process.  Threads hand their output
%   down to those that they create, and that of a request ends with it.

on_console(Goal) :-
    current_output(Out),
    setup_call_cleanup(
        set_output(user_output),
        once(Goal),
        set_output(Out)).
