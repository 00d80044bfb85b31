:- module(typhon_cell_frames,
          [ cell_frame_write/2,         % +Out, +Term
            cell_frame_read/2,          % +In, -Term
            cell_frame_text/2,          % +In, -Text
            cell_text_term/2,           % +Text, -Term
            cell_word/2,                % ?Kind, ?PI
            cell_state/2,               % +State0, -State
            state_mark/2,               % +Module, -Mark
            state_changes/3,            % +Module, +Mark, -Changes
            state_predicate/2           % +Module, -Head
          ]).
:- use_module(library(lists), [max_list/2, member/2, reverse/2]).
:- use_module(library(occurs), [sub_term/2]).
:- use_module(library(apply), [exclude/3]).
:- use_module(library(error), [resource_error/1, syntax_error/1]).
:- use_module('../../kernel/base/text', [term_text/2, text_term/2]).
:- use_module('../../kernel/program', [clause_parts/3]).

/** <module> The protocol between the gatekeeper and a cell

Each frame is a length, four bytes, the most significant first, and the
canonical text of one term.  A binary codec is no option: one wrong byte in a
recorded term can end the process that decodes it.

The gatekeeper sends

    host(Rules, PIs, Limits)    bind the cell to a host.  Rules is `guarded` or
                                the text of its rules; PIs are the services of
                                its place; Limits are the limits of agents,
                                What-Most
    turn(N, Id, Hash, Program, State, Known, Forget, Goals)
                                run Goals of the agent Id.  Program is as of
                                code_receive/2 or `known`, State as of
                                agent_state/2 or `same`; Known are facts that
                                do not change in a turn; Forget are agents
                                that have left the host
    answer(N, Answer)           answer a request: solutions(Goals),
                                raised(Error), or changed(State, Answer)

and the cell sends

    ready                       the cell has started
    told(N, Goals)              the agent has called these Goals in the turn N;
                                they have no answer.  If one raises an error
                                the next answer reports it, or the turn ends
                                with it
    request(N, Goal)            the agent has called Goal, which has an answer
    changing(N, Goal, Changes)  the same for a Goal that changes the state;
                                the agent has made Changes before
    lacks(N)                    the cell does not have the program or the
                                state for the turn N
    over(N, What)               in the turn N the agent has exceeded the limit
                                What; the cell ends
    ends(N, stack)              in the turn N the agent ends by the error of a
                                full stack, which it may have raised; the cell
                                ends
    outcome(N, Outcome, Note, Changes)
                                the turn N is over, see machine_run/3

Changes are PI-Clauses, where Clauses are all clauses that the predicate PI of
the state has now.

*Threading*: no state.
*/

%   A state within the default of the quota `state` fits into a frame.

most_bytes(8 388 608).

%!  cell_frame_write(+Out, +Term) is det.
%
%   Write Term as a frame, and flush Out.
%
%   @error resource_error(cell_frame) Term is too large

cell_frame_write(Out, Term) :-
    term_text(Term, Bytes0),
    unlike_numbers(Bytes0, Term, Bytes),
    string_length(Bytes, Length),
    most_bytes(Most),
    (   Length =< Most
    ->  true
    ;   resource_error(cell_frame)
    ),
    L3 is Length>>24, L2 is (Length>>16) /\ 255,
    L1 is (Length>>8) /\ 255, L0 is Length /\ 255,
    string_codes(Head, [L3,L2,L1,L0]),
    write(Out, Head),
    write(Out, Bytes),
    flush_output(Out).

%!  cell_frame_read(+In, -Term) is det.
%
%   Term is `end_of_file` at the end of In.

cell_frame_read(In, Term) :-
    (   cell_frame_text(In, Text)
    ->  text_term(Text, Term)
    ;   Term = end_of_file
    ).

%!  cell_text_term(+Text, -Term) is det.
%
%   Term is the term of a frame that a cell has written as Text.  A number of
%   30,000 digits is refused: reading it takes time quadratic in its length and
%   cannot be interrupted.
%
%   @error syntax_error(Message) Text is not the text of one term

cell_text_term(Text, Term) :-
    no_long_number(Text),
    text_term(Text, Term),
    ( Term == end_of_file -> syntax_error(no_term) ; true ).

%!  cell_frame_text(+In, -Text:string) is semidet.
%
%   Fails at the end of In.
%
%   @error syntax_error(Message) the frame is truncated, or too large: then
%   nothing of its body was read

cell_frame_text(In, Bytes) :-
    read_string(In, 4, Head),
    string_codes(Head, [L3,L2,L1,L0]),
    Length is L3<<24 \/ L2<<16 \/ L1<<8 \/ L0,
    frame_body(In, Length, Bytes).

frame_body(In, Length, Bytes) :-
    most_bytes(Most),
    (   Length > Most
    ->  syntax_error(frame_too_large)
    ;   read_string(In, Length, Bytes),
        string_length(Bytes, Length)
    ->  true
    ;   syntax_error(truncated_frame)
    ).

                /*******************************
                *         LONG NUMBERS         *
                *******************************/

%   no_long_number(+Bytes): any number of 30,000 digits contains one of the
%   blocks of 15,000 characters that begin at a multiple of 15,000.  Digits may
%   be of any base and separated by blanks, so a block of letters and blanks is
%   refused, too.
%
%   @error syntax_error(long_number)

no_long_number(Bytes) :-
    (   like_number(Bytes, _)
    ->  syntax_error(long_number)
    ;   true
    ).

like_number(Bytes, Before) :-
    digits(Bytes, Before, Digits),
    (   sub_string(Digits, _, 1, _, " ")
    ->  true
    ;   number_begins(Bytes, Before, Digits)
    ).

%   unlike_numbers(+Bytes0, +Term, -Bytes): Bytes is text of Term in which no
%   block looks like a part of a long number, if Term has no such number.  Then
%   a block that does is in quotes, with the blocks that it extends to: three of
%   their characters become escape sequences.  The first ten may be part of one
%   already.

unlike_numbers(Bytes0, Term, Bytes) :-
    (   ( \+ like_number(Bytes0, _) ; has_long_number(Term) )
    ->  Bytes = Bytes0
    ;   findall(Block, digits(Bytes0, Block, _), Blocks),
        findall(Block, like_number(Bytes0, Block), Firsts),
        extended(Blocks, Firsts, none, Long),
        findall(At, ( member(Block, Long), member(Offset, [10,7500,14 989]),
                      At is Block+Offset ), Ats),
        escaped(Ats, 0, Bytes0, Pieces),
        atomics_to_string(Pieces, Bytes1),
        unlike_numbers(Bytes1, Term, Bytes)
    ).

extended([], _, _, []).
extended([Block|Blocks], Firsts, Before, Long0) :-
    (   ( Before == Block ; memberchk(Block, Firsts) )
    ->  Next is Block+15 000,
        Long0 = [Block|Long]
    ;   Next = none,
        Long0 = Long
    ),
    extended(Blocks, Firsts, Next, Long).

escaped([], From, Bytes, [Piece]) :-
    sub_string(Bytes, From, _, 0, Piece).
escaped([At|Ats], From, Bytes, [Piece,Escape|Pieces]) :-
    Length is At-From,
    sub_string(Bytes, From, Length, _, Piece),
    sub_string(Bytes, At, 1, _, Char),
    string_codes(Char, [Code]),
    format(string(Escape), "\\x~16r\\", [Code]),
    Next is At+1,
    escaped(Ats, Next, Bytes, Pieces).

has_long_number(Term) :-
    sub_term(Number, Term),
    rational(Number, N, D),
    msb(max(abs(N), D)+1) > 45 000,
    !.

%   digits(+Bytes, -Before, -Digits) is nondet.

digits(Bytes, Before, Digits) :-
    string_length(Bytes, Length),
    Last is Length//15 000 - 1,
    between(0, Last, Part),
    Before is Part*15 000,
    sub_string(Bytes, Before, 15 000, _, Digits),
    split_string(Digits, "", " _0123456789abcdefghijklmnopqrstuvwxyz\c
                              ABCDEFGHIJKLMNOPQRSTUVWXYZ", [""]).

%   number_begins(+Bytes, +Before, +Digits): the token that contains Digits
%   begins with a digit, or follows a base such as 36'.  A token that begins
%   more than 15,000 characters before fills an earlier block, which was checked
%   then.

number_begins(Bytes, Before, Digits) :-
    From is max(0, Before-15 000),
    Length is Before-From,
    sub_string(Bytes, From, Length, _, Text),
    string_codes(Text, Codes),
    reverse(Codes, Reversed),
    string_code(1, Digits, Code),
    word_begins(Reversed, Code, First, Rest),
    ( Rest == [] -> From =:= 0 ; true ),
    (   code_type(First, digit)
    ;   Rest = [0'\',Base|_],
        code_type(Base, digit)
    ),
    !.

word_begins([Code|Codes], _, First, Rest) :-
    code_type(Code, csym),
    !,
    word_begins(Codes, Code, First, Rest).
word_begins(Rest, First, First, Rest).

                /*******************************
                *            WORDS             *
                *******************************/

%!  cell_word(?Kind, ?PI) is nondet.
%
%   The gatekeeper carries out calls of PI for an agent in a cell.  Kind is
%
%     - `fixed`: the answer does not change during a turn; the gatekeeper sends
%       it with the turn
%     - `tells`: the call has no answer
%     - `looks`: the call changes nothing
%     - `acts`: the call changes the host
%     - `changes`: the call changes the state of the agent

cell_word(fixed, self/1).
cell_word(fixed, here/1).
cell_word(fixed, home/1).
cell_word(fixed, parent/1).
cell_word(fixed, hops/1).
cell_word(looks, now/1).
cell_word(looks, neighbours/1).
cell_word(looks, neighbour/2).
cell_word(looks, host_load/1).
cell_word(acts, next_host/2).
cell_word(tells, send/2).
cell_word(tells, leave/1).
cell_word(tells, log/1).
cell_word(tells, result/1).
cell_word(tells, message_failed/2).
cell_word(acts, leave_new/1).
cell_word(looks, sense/1).
cell_word(acts, take/1).
cell_word(acts, emit/1).
cell_word(acts, emit/2).
cell_word(acts, withdraw/1).
cell_word(acts, pheromone/3).
cell_word(acts, create/3).
cell_word(acts, monitor/1).
cell_word(acts, monitor/2).
cell_word(acts, unmonitor/1).
cell_word(looks, followers/1).
cell_word(acts, dispose/1).
cell_word(acts, dispose/2).
cell_word(acts, offer/2).
cell_word(acts, unoffer/1).
cell_word(looks, find/3).
cell_word(acts, enter/1).
cell_word(acts, seal/3).
cell_word(acts, unseal/2).
cell_word(changes, attach/1).
cell_word(changes, detach/1).

                /*******************************
                *            STATE             *
                *******************************/

%!  cell_state(+State0, -State) is det.
%
%   State is the part of State0 that a cell may see: predicates of the platform,
%   whose names begin with `$`, stay with the gatekeeper.

cell_state(state(Empty0, Clauses0), state(Empty, Clauses)) :-
    exclude(reserved_indicator, Empty0, Empty),
    exclude(reserved_clause, Clauses0, Clauses).

reserved_indicator(Name/_) :-
    reserved(Name).

reserved_clause(Clause) :-
    clause_parts(Clause, Head, _),
    functor(Head, Name, _),
    reserved(Name).

reserved(Name) :-
    sub_atom(Name, 0, _, _, $).

%!  state_predicate(+Module, -Head) is nondet.
%
%   Head is of a predicate of the agent's state that a cell may see.

state_predicate(Module, Head) :-
    '$c_current_predicate'(_, Module:Head),
    '$get_predicate_attribute'(Module:Head, (dynamic), 1),
    \+ '$get_predicate_attribute'(Module:Head, imported, _),
    functor(Head, Name, _),
    \+ reserved(Name).

%!  state_mark(+Module, -Mark) is det.
%!  state_changes(+Module, +Mark, -Changes:list) is det.
%
%   Mark differs whenever the state of Module has changed.  Changes, PI-Clauses,
%   are the predicates that have changed since Mark.

state_mark(Module, Latest/Count) :-
    findall(Last,
            ( state_predicate(Module, Head), modified(Module, Head, Last) ),
            Lasts),
    length(Lasts, Count),
    max_list([0|Lasts], Latest).

modified(Module, Head, Last) :-
    (   '$get_predicate_attribute'(Module:Head, last_modified_generation, Last0)
    ->  Last = Last0
    ;   Last = 0                        % has never had a clause
    ).

state_changes(Module, Since/_, Changes) :-
    findall(PI-Clauses, changed(Module, Since, PI, Clauses), Changes).

changed(Module, Since, Name/Arity, Clauses) :-
    state_predicate(Module, Head),
    modified(Module, Head, Last),
    Last > Since,
    functor(Head, Name, Arity),
    findall(Clause, state_clause(Module, Head, Clause), Clauses).

state_clause(Module, Head, Clause) :-
    clause(Module:Head, Body),
    ( Body == true -> Clause = Head ; Clause = (Head:-Body) ).
