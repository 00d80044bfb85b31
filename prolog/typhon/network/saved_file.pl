:- module(typhon_saved_file,
          [ saved_write/2,              % +File, +Terms
            saved_read/2                % +File, -Terms
          ]).
:- use_module(library(apply), [maplist/3]).
:- use_module(library(error), [existence_error/2]).
:- use_module(library(lists), [append/3, member/2]).
:- autoload(library(readutil), [read_file_to_string/3]).
:- use_module(library(sha), [hash_atom/2, sha_hash/3]).
:- use_module('../kernel/base/text', [term_text/2, text_term/2]).

/** <module> Terms in a file that is whole, or is not read

One clause per line, in canonical text:

    typhon_saved(Version, Prolog, Platform).
    ...
    end(Sum).

Sum is the SHA-256 of all lines before.  The file gets its name when it is
whole: what was there before stays until then.

*Threading*: any thread.
*/

:- multifile
    prolog:error_message//1.

format_version(1).

%!  saved_write(+File, +Terms:list) is det.
%
%   @error permission_error(open, source_sink, File),
%   existence_error(source_sink, File)

saved_write(Spec, Terms) :-
    absolute_file_name(Spec, File),
    atom_concat(File, '.new', New),
    header(Header),
    catch(( write_lines(New, write, [Header|Terms]),
            sum(New, Sum),
            write_lines(New, append, [end(Sum)]),
            rename_file(New, File) ),
          Ball,
          ( catch(delete_file(New), error(_, _), true),
            about(File, New, Ball, Told),
            throw(Told) )).

%   The file New is not in use yet.

about(File, New, error(Formal0, Context), error(Formal, Context)) :-
    Formal0 =.. Parts0,
    append(Kind, [New], Parts0),
    !,
    append(Kind, [File], Parts),
    Formal =.. Parts.
about(_, _, Ball, Ball).

header(typhon_saved(Version, Prolog, Platform)) :-
    format_version(Version),
    current_prolog_flag(version, Prolog),
    current_prolog_flag(arch, Platform).

write_lines(File, Mode, Terms) :-
    setup_call_cleanup(
        open(File, Mode, Out, [encoding(octet), newline(posix)]),
        forall(member(Term, Terms), write_line(Out, Term)),
        close(Out)).

write_line(Out, Term) :-
    term_text(Term, Bytes),
    format(Out, "~s~n", [Bytes]).

sum(File, Sum) :-
    read_file_to_string(File, Bytes, [encoding(octet)]),
    sum_of(Bytes, Sum).

sum_of(Bytes, Sum) :-
    sha_hash(Bytes, Hash, [algorithm(sha256), encoding(octet)]),
    hash_atom(Hash, Sum).

%!  saved_read(+File, -Terms:list) is det.
%
%   @error existence_error(source_sink, File)
%   @error network_damaged(File, Why): what it is not, or `cut_short`, `changed`
%   @error network_version(File, Version): written by another version

saved_read(Spec, Terms) :-
    absolute_file_name(Spec, File),
    must_be_there(File),
    read_file_to_string(File, Bytes, [encoding(octet)]),
    split_string(Bytes, "\n", "", Parts),
    must_be_ours(Parts, File),
    (   append(Lines, [End, ""], Parts),
        catch(text_term(End, end(Sum)), error(_, _), fail)
    ->  true
    ;   damaged(File, cut_short)
    ),
    before_end(Bytes, End, Body),
    (   sum_of(Body, Sum)
    ->  true
    ;   damaged(File, changed)
    ),
    Lines = [_|Rest],
    maplist(text_term, Rest, Terms).

must_be_there(File) :-
    (   exists_file(File)
    ->  true
    ;   existence_error(source_sink, File)
    ).

%   What is not ours is not parsed.

must_be_ours([First|_], File) :-
    sub_string(First, 0, _, _, "typhon_saved("),
    catch(text_term(First, typhon_saved(Version, _, _)), error(_, _), fail),
    !,
    (   format_version(Version)
    ->  true
    ;   throw(error(network_version(File, Version), _))
    ).
must_be_ours(_, File) :-
    damaged(File, no_network).

before_end(Bytes, End, Body) :-
    string_length(Bytes, Length),
    string_length(End, EndLength),
    Before is Length-EndLength-1,
    sub_string(Bytes, 0, Before, _, Body).

damaged(File, Why) :-
    throw(error(network_damaged(File, Why), _)).

                /*******************************
                *           MESSAGES           *
                *******************************/

prolog:error_message(network_damaged(File, Why)) -->
    [ '~w: '-[File] ],
    why(Why).
prolog:error_message(network_version(File, Version)) -->
    [ '~w: was saved in format ~w, which this version cannot read'-
      [File, Version] ].

why(no_network) -->
    [ 'is not a file of network_save/2'-[] ].
why(cut_short) -->
    [ 'is cut short'-[] ].
why(changed) -->
    [ 'is not as it was written: its sum is another'-[] ].
