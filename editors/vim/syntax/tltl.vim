" Colours of .tltl files, for Vim and Neovim.
if exists("b:current_syntax")
  finish
endif

syntax keyword tltlDeclaration import signal entity param clock predicate let exclusive spec test
syntax keyword tltlClause reach keep avoid require level limit judge semantics tag
syntax keyword tltlClause all any when otherwise
syntax keyword tltlOperator not and or implies iff then eventually always next weak_next until weak_until
syntax keyword tltlOperator release strong_release F G X N U W R M
syntax keyword tltlOperator once historically previously begins ends
syntax keyword tltlConstant true false inf
syntax match tltlConstant "\v[⊤⊥]"
syntax match tltlOperator "\v[-+*/^=<>!&|¬∧∨⇒→⇔↔◇□○𝒰≤≥]|\[\]"

" Words that may also be names: they have a colour only where they are keywords.
syntax match tltlClause "\v<step>\ze\s+%(\a|_|!|¬|\(|\d+x>)"
syntax match tltlClause "\v<expect>\ze\s+\a"
syntax match tltlConstant "\v%(<expect\s+)@20<=%(satisfied|holding|pending|violated|progress|state)>"
syntax match tltlConstant "\v%(<judge\s+at\s+)@20<=%(goal|limit)>"
syntax match tltlConstant "\v%(<semantics\s+)@20<=%(finite|infinite)>"
syntax match tltlWord "\v%(<judge\s+)@20<=at>"
syntax match tltlWord "\v%(<clock\s+)@20<=varies>"
syntax match tltlWord "\v<%(within|for|after)>\ze\s*\d"
syntax match tltlOperator "\v<since>\ze\s+%(%(and|or|implies|iff|then|until|weak_until|release|strong_release|since|in|[UWRM])>)@!%(\a|[_(!¬◇□○⊤⊥[:digit:]])"
syntax match tltlWord "\v<in>\ze\s*[\[(]"
syntax match tltlWord "\v%(\w|\))@1<=\s+\zs<is>\ze\s+%(not\s+)?%(%(and|or|implies|iff|then|until|is)>)@!%(\a|_)"
syntax match tltlWord "\v<as>\ze\s+%(\a|_)"
syntax match tltlWord "\v%(\"\s*)@8<=<for>\ze\s+%(\a|_)"
syntax match tltlType "\v:\s*\zs<%(number|ratio|length|time|speed|angle|int|bool|entity|formula)>%(\s*[.(<>+*/^-])@!"
syntax match tltlFunction "\v<%(min|max|abs|clamp|sqrt|exp|tanh|times|times_since|times_within|time_since|time_holding|total_time|total_time_since|previous|initial|highest|lowest|highest_since|lowest_since|value_at)>\ze\s*\("

syntax match tltlNumber "\v<\d+%(\.\d+)?%([eE][+-]?\d+)?%(x>)?" nextgroup=tltlUnit skipwhite
syntax match tltlUnit contained "\v\%|%(steps|step|deg|min|rad|Hz|cm|km|ms|h|m|s)>%(\.\a)@!"
syntax region tltlString start=+"+ end=+"+ oneline
syntax match tltlComment "//.*$" contains=@Spell
syntax match tltlDocumentation "///.*$" contains=@Spell

highlight default link tltlDeclaration Keyword
highlight default link tltlClause Statement
highlight default link tltlWord Statement
highlight default link tltlOperator Operator
highlight default link tltlConstant Constant
highlight default link tltlType Type
highlight default link tltlFunction Function
highlight default link tltlNumber Number
highlight default link tltlUnit Type
highlight default link tltlString String
highlight default link tltlComment Comment
highlight default link tltlDocumentation SpecialComment

let b:current_syntax = "tltl"
